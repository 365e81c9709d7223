//! The little linear algebra the core needs. Everything is three wide; a two-joint device
//! leaves the third row and column at zero.

use nalgebra::{Matrix3, Vector3};

/// One value per joint, or per base-frame coordinate.
pub type V3 = Vector3<f64>;

/// Joint or tip matrix; Jacobians have one column per joint.
pub type M3 = Matrix3<f64>;

/// Largest eigenvalue of a symmetric 3×3 matrix, in closed form (Smith 1961).
///
/// Relative accuracy 1e-8. A zero row and column adds the eigenvalue 0, which never is the
/// largest of a positive semidefinite matrix.
#[must_use]
pub fn lambda_max_sym(a: &M3) -> f64 {
    let mean = a.trace() / 3.0;
    let deviator = a - M3::from_diagonal_element(mean);
    let p = (deviator.norm_squared() / 6.0).sqrt();
    if p <= f64::EPSILON * mean.abs() {
        return mean;
    }
    let r = (deviator / p).determinant() / 2.0;
    mean + 2.0 * p * (r.clamp(-1.0, 1.0).acos() / 3.0).cos()
}

/// 1/x for each axis in use; an unused axis holds zero and keeps it.
#[must_use]
pub fn invert_axes(values: &V3) -> V3 {
    values.map(|value| if value > 0.0 { value.recip() } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiple_of_the_identity_has_its_factor_as_eigenvalue() {
        assert_eq!(lambda_max_sym(&M3::from_diagonal_element(3.0)), 3.0);
        assert_eq!(lambda_max_sym(&M3::zeros()), 0.0);
    }

    #[test]
    fn padding_with_zeros_leaves_the_largest_eigenvalue() {
        let padded = M3::new(2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0);
        assert!((lambda_max_sym(&padded) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn unused_axes_stay_zero() {
        assert_eq!(
            invert_axes(&V3::new(4.0, 0.5, 0.0)),
            V3::new(0.25, 2.0, 0.0)
        );
    }
}
