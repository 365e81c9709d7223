use hapticd_control::linear::{lambda_max_sym, M3};
use proptest::prelude::*;

proptest! {
    #[test]
    fn closed_form_agrees_with_the_iterative_eigenvalue(
        entries in prop::array::uniform9(-1.0..1.0_f64), exponent in -6..7_i32,
    ) {
        let a = 10.0_f64.powi(exponent) * M3::from_row_slice(&entries);
        let gram = a * a.transpose();
        let expected = gram.symmetric_eigenvalues().max();
        prop_assert!((lambda_max_sym(&gram) - expected).abs() <= 1e-8 * expected);
    }
}
