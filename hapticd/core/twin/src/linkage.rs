//! Mass matrices and velocity and gravity torques of both linkages.

use crate::model::{PhantomLinkageModel, RhombusLinkageModel};
use hapticd_control::io::Axes;
use hapticd_control::linear::{M3, V3};

/// Rigid-body dynamics M(q) q̈ + bias(q, q̇) = τ.
pub trait Linkage {
    /// Mass matrix M, kg·m², and Coriolis, centrifugal and gravity torques C q̇ + G, N·m.
    /// An unused joint has a mass of its own and no coupling.
    fn dynamics(&self, q: &V3, qd: &V3) -> (M3, V3);
    /// Potential energy, J.
    fn potential_j(&self, q: &V3) -> f64;

    /// Mass matrix M, kg·m².
    fn mass(&self, q: &V3) -> M3 {
        self.dynamics(q, &V3::zeros()).0
    }
}

/// PHANTOM: Cavusoglu's dynamics as in mahilab/Phantom, with the rotors added.
///
/// M11 depends on q2 and q3, M23 on q3 − q2; M22 and M33 are constant, M12 = M13 = 0.
#[derive(Clone, Copy, Debug)]
pub struct PhantomLinkage {
    /// M11 = m11 + m11_q2 cos 2q2 + m11_q3 cos 2q3 + cross_base cos q2 sin q3.
    m11: f64,
    m11_q2: f64,
    m11_q3: f64,
    cross_base: f64,
    m22: f64,
    m33: f64,
    /// M23 = cross sin(q3 − q2).
    cross: f64,
    /// G2 = g2 cos q2, G3 = g3 sin q3.
    g2: f64,
    g3: f64,
}

impl PhantomLinkage {
    /// The linkage with links `l1`, `l2` (m) and rotors of `rotor_kg_m2` behind ratios `ratio`.
    #[must_use]
    pub fn new(
        model: &PhantomLinkageModel,
        l1: f64,
        l2: f64,
        ratio: &Axes,
        rotor_kg_m2: f64,
    ) -> Self {
        let [ia_xx, ia_yy, ia_zz] = model.forearm_kg_m2;
        let [ic_xx, ic_yy, ic_zz] = model.rod_kg_m2;
        let [ibe_xx, ibe_yy, ibe_zz] = model.upper_kg_m2;
        let [idf_xx, idf_yy, idf_zz] = model.lower_kg_m2;
        let (ma, mc) = (model.forearm_kg, model.rod_kg);
        let (l3, l5, l6) = (
            model.short_link_m,
            model.upper_offset_m,
            model.lower_offset_m,
        );
        let rotor = |axis: usize| ratio[axis] * ratio[axis] * rotor_kg_m2;
        let half_g = 0.5 * model.gravity_m_per_s2;
        Self {
            m11: 0.5
                * (ia_yy
                    + ia_zz
                    + 2.0 * model.base_kg_m2
                    + ibe_yy
                    + ibe_zz
                    + ic_yy
                    + ic_zz
                    + idf_yy
                    + idf_zz)
                + 0.125 * (4.0 * l1 * l1 * ma + l2 * l2 * ma + l1 * l1 * mc + 4.0 * l3 * l3 * mc)
                + rotor(0),
            m11_q2: 0.125 * (4.0 * (ibe_yy - ibe_zz + ic_yy - ic_zz) + l1 * l1 * (4.0 * ma + mc)),
            m11_q3: 0.125
                * (4.0 * (ia_yy - ia_zz + idf_yy - idf_zz) - l2 * l2 * ma - 4.0 * l3 * l3 * mc),
            cross_base: l1 * (l2 * ma + l3 * mc),
            m22: ibe_xx + ic_xx + l1 * l1 * ma + 0.25 * l1 * l1 * mc + rotor(1),
            m33: ia_xx + idf_xx + 0.25 * l2 * l2 * ma + l3 * l3 * mc + rotor(2),
            cross: 0.5 * l1 * (l2 * ma + l3 * mc),
            g2: half_g * (2.0 * l1 * ma + 2.0 * l5 * model.upper_kg + l1 * mc),
            g3: half_g * (l2 * ma + 2.0 * l3 * mc - 2.0 * l6 * model.lower_kg),
        }
    }
}

impl Linkage for PhantomLinkage {
    fn dynamics(&self, q: &V3, qd: &V3) -> (M3, V3) {
        let (s2, c2) = q[1].sin_cos();
        let (s3, c3) = q[2].sin_cos();
        // cos 2a = 2 cos² a − 1 = 1 − 2 sin² a
        let m11 = self.m11
            + self.m11_q2 * (2.0 * c2 * c2 - 1.0)
            + self.m11_q3 * (1.0 - 2.0 * s3 * s3)
            + self.cross_base * c2 * s3;
        let m11_by_q2 = -4.0 * self.m11_q2 * s2 * c2 - self.cross_base * s2 * s3;
        let m11_by_q3 = -4.0 * self.m11_q3 * s3 * c3 + self.cross_base * c2 * c3;
        let m23 = self.cross * (s3 * c2 - c3 * s2);
        let m23_by_q3 = self.cross * (c3 * c2 + s3 * s2);
        let mass = M3::new(m11, 0.0, 0.0, 0.0, self.m22, m23, 0.0, m23, self.m33);
        let bias = V3::new(
            (m11_by_q2 * qd[1] + m11_by_q3 * qd[2]) * qd[0],
            m23_by_q3 * qd[2] * qd[2] - 0.5 * m11_by_q2 * qd[0] * qd[0] + self.g2 * c2,
            -m23_by_q3 * qd[1] * qd[1] - 0.5 * m11_by_q3 * qd[0] * qd[0] + self.g3 * s3,
        );
        (mass, bias)
    }

    fn potential_j(&self, q: &V3) -> f64 {
        self.g2 * q[1].sin() - self.g3 * q[2].cos()
    }
}

/// Rhombus of uniform links in the horizontal plane; each joint carries one motor and one brake.
#[derive(Clone, Copy, Debug)]
pub struct RhombusLinkage {
    /// M11 = M22.
    diagonal: f64,
    /// M12 = h cos δ, δ = θ2 − θ1.
    h: f64,
}

impl RhombusLinkage {
    /// The linkage with links of `l` (m).
    #[must_use]
    pub fn new(model: &RhombusLinkageModel, l: f64) -> Self {
        let link = model.link_kg * l * l;
        let tip = model.tip_kg * l * l;
        let drive = model.belt_ratio.powi(2)
            * (model.gear_ratio.powi(2) * model.rotor_kg_m2 + model.brake_rotor_kg_m2);
        Self {
            // Inner link about the joint 1/3, outer link carried along 1, outer link turning 1/4 + 1/12.
            diagonal: link * (1.0 / 3.0 + 1.0 + 0.25 + 1.0 / 12.0) + tip + drive,
            h: link * (0.5 + 0.5) + tip,
        }
    }
}

impl Linkage for RhombusLinkage {
    fn dynamics(&self, q: &V3, qd: &V3) -> (M3, V3) {
        let (sin, cos) = (q[1] - q[0]).sin_cos();
        let (m12, swing) = (self.h * cos, self.h * sin);
        let m11 = self.diagonal;
        let mass = M3::new(m11, m12, 0.0, m12, m11, 0.0, 0.0, 0.0, 1.0);
        (
            mass,
            V3::new(-swing * qd[1] * qd[1], swing * qd[0] * qd[0], 0.0),
        )
    }

    fn potential_j(&self, _q: &V3) -> f64 {
        0.0
    }
}
