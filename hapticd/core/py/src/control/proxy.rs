use super::value_error;
use hapticd_control::io::Axes;
use hapticd_control::proxy;
use hapticd_control::scene::Wall;
use hapticd_control::supports::Supports;
use pyo3::prelude::*;

/// The proxy of a tip among walls.
#[pyclass(module = "hapticd._core")]
pub struct Proxy {
    walls: Vec<Wall>,
    proxy: Box<proxy::Proxy>,
    around: Box<Supports>,
}

#[pymethods]
impl Proxy {
    #[new]
    fn new(walls_json: &str) -> PyResult<Self> {
        let mut proxy = Self {
            walls: Vec::new(),
            proxy: Box::default(),
            around: Box::default(),
        };
        proxy.edit(walls_json)?;
        Ok(proxy)
    }

    fn edit(&mut self, walls_json: &str) -> PyResult<()> {
        let walls: Vec<Wall> = serde_json::from_str(walls_json).map_err(value_error)?;
        let history = self.proxy.history().carried(&self.walls, &walls);
        self.proxy.adopt(&walls, history);
        self.walls = walls;
        Ok(())
    }

    fn follow(&mut self, x: Axes) -> (Axes, Vec<(usize, Axes, f64)>) {
        self.proxy.follow(&self.walls, &x.into(), &mut self.around);
        let facings = self.proxy.facings().as_slice().iter();
        let rows = facings.map(|facing| (facing.wall, facing.normal, facing.offset_m));
        (self.proxy.point().into(), rows.collect())
    }
}
