//! Durations counted in logarithmic buckets: fixed size, no allocation, at most 12.5 % wide.

/// Buckets per octave, as a power of two.
const SUB_BITS: u32 = 3;
const SUB: usize = 1 << SUB_BITS;
/// Durations of 2^36 ns (69 s) and more share the last bucket.
const MAX_BITS: u32 = 36;

/// Buckets of a histogram.
pub const BUCKETS: usize = SUB + (MAX_BITS - SUB_BITS) as usize * SUB;

/// Words of a histogram in shared memory.
pub const HISTOGRAM_WORDS: usize = BUCKETS + 3;

/// A histogram of durations in ns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    /// Durations counted.
    pub count: u64,
    /// Their sum, ns.
    pub sum_ns: u64,
    /// The longest, ns.
    pub max_ns: u64,
    /// How many fell in each bucket.
    pub counts: [u64; BUCKETS],
}

impl Default for Histogram {
    fn default() -> Self {
        Self {
            count: 0,
            sum_ns: 0,
            max_ns: 0,
            counts: [0; BUCKETS],
        }
    }
}

/// Bucket of a duration.
fn bucket(ns: u64) -> usize {
    let ns = ns.min((1 << MAX_BITS) - 1);
    let Some(octave) = ns.checked_ilog2().filter(|log| *log >= SUB_BITS) else {
        return ns as usize;
    };
    let shift = octave - SUB_BITS;
    (shift as usize + 1) * SUB + ((ns >> shift) as usize - SUB)
}

/// Smallest duration of bucket `index`, ns; of `BUCKETS` itself the end of the last bucket.
#[must_use]
pub fn edge_ns(index: usize) -> u64 {
    if index < SUB {
        return index as u64;
    }
    let shift = index / SUB - 1;
    ((SUB + index % SUB) as u64) << shift
}

impl Histogram {
    /// Counts one duration.
    pub fn record(&mut self, ns: u64) {
        self.count += 1;
        self.sum_ns = self.sum_ns.saturating_add(ns);
        self.max_ns = self.max_ns.max(ns);
        self.counts[bucket(ns)] += 1;
    }

    /// Upper edge of the bucket that holds the quantile, never above the longest; 0 when empty.
    #[must_use]
    pub fn quantile_ns(&self, quantile: f64) -> u64 {
        let rank = (quantile * self.count as f64).ceil() as u64;
        let mut seen = 0;
        for (index, count) in self.counts.iter().enumerate() {
            seen += count;
            if seen > 0 && seen >= rank {
                return edge_ns(index + 1).min(self.max_ns);
            }
        }
        self.max_ns
    }

    /// The histogram as words.
    pub fn encode(&self, encoder: &mut crate::codec::Encoder<'_>) {
        encoder
            .word(self.count)
            .word(self.sum_ns)
            .word(self.max_ns)
            .words(&self.counts);
    }

    /// The histogram in words; `None` past the end.
    #[must_use]
    pub fn decode(decoder: &mut crate::codec::Decoder<'_>) -> Option<Self> {
        Some(Self {
            count: decoder.word()?,
            sum_ns: decoder.word()?,
            max_ns: decoder.word()?,
            counts: decoder.array()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};
    use proptest::prelude::*;

    #[test]
    fn edges_rise_without_gaps_and_buckets_start_at_their_edge() {
        for index in 0..BUCKETS {
            assert!(edge_ns(index) < edge_ns(index + 1));
            assert_eq!(bucket(edge_ns(index)), index);
            assert_eq!(bucket(edge_ns(index + 1) - 1), index);
        }
        assert_eq!(edge_ns(BUCKETS), 1 << MAX_BITS);
    }

    proptest! {
        #[test]
        fn a_bucket_is_never_wider_than_an_eighth(ns in 8u64..1 << MAX_BITS) {
            let index = bucket(ns);
            prop_assert!(edge_ns(index) <= ns && ns < edge_ns(index + 1));
            prop_assert!((edge_ns(index + 1) - edge_ns(index)) * 8 <= edge_ns(index));
        }

        #[test]
        fn quantiles_agree_with_the_sorted_list(
            mut list in prop::collection::vec(0u64..1 << 40, 1..200), percent in 1u32..=100
        ) {
            let mut histogram = Histogram::default();
            list.iter().for_each(|ns| histogram.record(*ns));
            list.sort_unstable();
            let rank = (list.len() * percent as usize).div_ceil(100);
            let exact = list[rank - 1];
            let estimate = histogram.quantile_ns(f64::from(percent) / 100.0);
            prop_assert!(estimate >= exact.min((1 << MAX_BITS) - 1));
            prop_assert!(estimate as f64 <= exact as f64 * 1.125 + 1.0);
        }

        #[test]
        fn words_carry_the_whole_histogram(list in prop::collection::vec(any::<u64>(), 0..50)) {
            let mut histogram = Histogram::default();
            list.iter().for_each(|ns| histogram.record(*ns));
            let mut words = [0; HISTOGRAM_WORDS];
            histogram.encode(&mut Encoder::new(&mut words));
            prop_assert_eq!(Histogram::decode(&mut Decoder::new(&words)), Some(histogram));
        }
    }
}
