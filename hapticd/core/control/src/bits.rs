//! Bit sets from conditions.

/// The union of the bits whose condition holds.
#[must_use]
pub fn union(pairs: &[(bool, u64)]) -> u64 {
    pairs
        .iter()
        .filter(|(holds, _)| *holds)
        .fold(0, |bits, (_, bit)| bits | bit)
}

/// One bit per joint.
#[must_use]
pub fn joints(conditions: &[bool; 3]) -> u64 {
    let [first, second, third] = *conditions;
    union(&[(first, 1), (second, 2), (third, 4)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn union_takes_each_bit_that_holds_once() {
        assert_eq!(union(&[(true, 1), (false, 2), (true, 5)]), 5);
    }

    #[test]
    fn joints_count_from_the_lowest_bit() {
        assert_eq!(joints(&[true, false, true]), 0b101);
        assert_eq!(joints(&[false, true, false]), 0b010);
    }
}
