//! Which walls the tip is in.

use crate::facing::Facing;
use crate::linear::V3;

/// Walls named in a record at most.
pub const MAX_NAMED: usize = 3;

/// What the tip touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Walls the tip is in; walls with η = 1 do not exist.
    pub count: usize,
    /// Index of the deepest; [`usize::MAX`] when free.
    pub wall: usize,
    /// Depth in the deepest, m.
    pub depth_m: f64,
    /// Normal of the deepest, zero when free.
    pub normal: V3,
    /// Indices of the walls touched, deepest first; [`usize::MAX`] where there are fewer.
    pub touched: [usize; MAX_NAMED],
    /// Where the tip would rest were every wall rigid, m.
    pub proxy: V3,
}

/// No wall.
const NONE: usize = usize::MAX;

impl Contact {
    /// No wall touched at `x`, m.
    #[must_use]
    pub fn free(x: &V3) -> Self {
        Self {
            count: 0,
            wall: NONE,
            depth_m: 0.0,
            normal: V3::zeros(),
            touched: [NONE; MAX_NAMED],
            proxy: *x,
        }
    }
}

/// The walls that contain the tip `x`, m, whose proxy rests at `proxy`, m.
#[must_use]
pub fn contact(facings: &[Facing], x: &V3, proxy: &V3) -> Contact {
    let mut found = Contact::free(proxy);
    let mut depths_m = [0.0; MAX_NAMED];
    let mut rest = facings;
    while let Some(first) = rest.first() {
        let same = rest.iter().take_while(|facing| facing.wall == first.wall);
        let (of_wall, others) = rest.split_at(same.count());
        rest = others;
        if let Some((depth_m, facing)) = deepest(of_wall, x) {
            found.count += 1;
            rank(&mut found.touched, &mut depths_m, facing.wall, depth_m);
            if depth_m > found.depth_m {
                found.wall = facing.wall;
                found.depth_m = depth_m;
                found.normal = facing.normal.into();
            }
        }
    }
    found
}

/// The deepest of one wall's planes behind which `x` is.
fn deepest<'a>(of_wall: &'a [Facing], x: &V3) -> Option<(f64, &'a Facing)> {
    let solid = of_wall.iter().filter(|facing| facing.eta < 1.0);
    solid
        .map(|facing| (facing.depth_m(x), facing))
        .filter(|(depth_m, _)| *depth_m > 0.0)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
}

/// Inserts a wall among the deepest.
fn rank(
    touched: &mut [usize; MAX_NAMED],
    depths_m: &mut [f64; MAX_NAMED],
    wall: usize,
    depth_m: f64,
) {
    let Some(place) = depths_m.iter().position(|other_m| depth_m > *other_m) else {
        return;
    };
    touched[place..].rotate_right(1);
    depths_m[place..].rotate_right(1);
    (touched[place], depths_m[place]) = (wall, depth_m);
}
