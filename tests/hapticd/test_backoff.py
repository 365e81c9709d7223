"""Back-off: neither a storm nor an eternity."""

from hapticd.backoff import Backoff


def test_pauses_grow_to_a_bound_and_start_again_after_success() -> None:
    backoff = Backoff(first_s=0.2, longest_s=10.0)
    pauses_s = [backoff.pause_s() for _ in range(12)]
    for k, pause_s in enumerate(pauses_s):
        nominal_s = min(0.2 * 2**k, 10.0)
        assert 0.75 * nominal_s <= pause_s <= nominal_s
    backoff.reset()
    assert backoff.pause_s() <= 0.2


def test_two_supervisors_do_not_beat_in_step() -> None:
    first, second = Backoff(), Backoff()
    assert [first.pause_s() for _ in range(8)] != [second.pause_s() for _ in range(8)]
