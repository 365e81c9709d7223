"""One spring drive with its drift compensation, motor side (WN §II, §III)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """k_T N·m/A, inductance H, dR Ω, K_P V/rad, K_D V·s/rad, λ rad/s."""

    k_t: float
    inductance: float
    d_r: float
    k_p: float
    k_d: float
    lam: float

    def k_theta(self, s: complex) -> complex:
        """τ/θ as printed, WN eq. 12: restoring, hence negative."""
        pd = (self.k_t + self.k_d + self.k_p / self.lam) * s + self.k_p
        lag = self.lam / (s + self.lam)
        return -self.k_t / (self.inductance * s + self.d_r) * lag * (pd + self.k_t * s**2 / self.lam)

    def torque_per_angle(self, s: complex) -> complex:
        """τ/θ for a held set-point by eliminating e_W and i from WN eq. 10 and 11."""
        filtered_rate = self.lam * s / (s + self.lam)
        e_w = -self.k_d * filtered_rate - self.k_p
        current = (e_w - self.k_t * s) / (self.inductance * s + self.d_r)
        return self.k_t * current

    def dc(self) -> float:
        """K_DC, N·m/rad (WN eq. 13)."""
        return self.k_t * self.k_p / self.d_r

    def hf(self) -> float:
        """K_HF = K_L, N·m/rad (WN eq. 14)."""
        return self.k_t**2 / self.inductance
