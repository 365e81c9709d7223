"""The numpy type of a tick record follows the core's schema."""

from hapticd import _core
from hapticd.model import load_model
from hapticd.record import record_dtype


def test_the_type_is_as_long_as_a_record() -> None:
    model = load_model("hhd")
    simulation = _core.Simulation(model.device_json, model.twin_json, 1000.0, 1)
    assert len(simulation.run(3)) == 3 * record_dtype().itemsize


def test_fields_keep_the_order_and_shape_of_the_schema() -> None:
    dtype = record_dtype()
    assert list(dtype.names or ()) == [field["name"] for field in _core.tick_schema()]
    assert dtype["tip_position_m"].shape == (3,)
    assert dtype["tick"].kind == "u"
    assert dtype["gain"].kind == "f"
