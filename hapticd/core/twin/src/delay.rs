//! A delay of whole ticks.

/// Gives every value back a fixed number of ticks later.
#[derive(Clone, Debug)]
pub struct Delay<T> {
    ring: Vec<T>,
    oldest: usize,
}

impl<T: Copy> Delay<T> {
    /// A delay of `ticks`, filled with `initial`.
    #[must_use]
    pub fn new(ticks: usize, initial: T) -> Self {
        Self {
            ring: vec![initial; ticks],
            oldest: 0,
        }
    }

    /// Takes this tick's value in, gives the delayed one out.
    pub fn pass(&mut self, value: T) -> T {
        if self.ring.is_empty() {
            return value;
        }
        let delayed = core::mem::replace(&mut self.ring[self.oldest], value);
        self.oldest = (self.oldest + 1) % self.ring.len();
        delayed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_comes_out_after_exactly_its_ticks() {
        for ticks in 0..5_usize {
            let mut delay = Delay::new(ticks, None);
            for now in 0..20_usize {
                assert_eq!(delay.pass(Some(now)), now.checked_sub(ticks));
            }
        }
    }
}
