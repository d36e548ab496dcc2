//! The covariance in this crate's form and in those of the textbooks, as plainly as they print
//! them.

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use kestirim_scalar::Scalar;
use nalgebra::{Matrix4, SMatrix, SVector, Vector4};

/// A covariance of four states that can be sheared, driven and updated.
pub(crate) trait Form<T: Scalar> {
    const NAME: &'static str;
    fn new(variances: [T; 4]) -> Self;
    /// Position `axis` (0, 1) moves by `a` of velocity `axis + 2`.
    fn shear(&mut self, axis: usize, a: T);
    fn add_variance(&mut self, state: usize, q: T);
    /// Takes in a row h with variance r; returns whether that was possible.
    fn update(&mut self, h: [T; 4], r: T) -> bool;
    fn matrix(&self) -> Matrix4<f64>;
}

fn doubles<T: Scalar>(m: &SMatrix<T, 4, 4>) -> Matrix4<f64> {
    m.map(T::to_f64)
}

/// The form of this crate.
pub(crate) struct Ours<T: Scalar>(Gaussian<T, 4>);

impl<T: Scalar> Form<T> for Ours<T> {
    const NAME: &'static str = "ours";
    fn new(variances: [T; 4]) -> Self {
        Self(Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances)))
    }
    fn shear(&mut self, axis: usize, a: T) {
        match axis {
            0 => self.0.covariance.shear::<0, 2>(a),
            _ => self.0.covariance.shear::<1, 3>(a),
        }
    }
    fn add_variance(&mut self, state: usize, q: T) {
        let mut noise = [T::ZERO; 4];
        noise[state] = q;
        self.0.covariance.add(&Covariance::from_variances(&noise));
    }
    fn update(&mut self, h: [T; 4], r: T) -> bool {
        let row = SparseRow::<T, 4>::new(std::array::from_fn(|i| (i, h[i])));
        self.0.update(&row, T::ZERO, r).is_ok()
    }
    fn matrix(&self) -> Matrix4<f64> {
        doubles(&self.0.covariance.to_matrix())
    }
}

/// The conventional form: P ← P − k gᵀ on a symmetric P.
pub(crate) struct Conventional<T: Scalar>(SMatrix<T, 4, 4>);

/// Joseph's form: P ← (1 − k h) P (1 − k h)ᵀ + k R kᵀ on a symmetric P.
pub(crate) struct Joseph<T: Scalar>(SMatrix<T, 4, 4>);

fn symmetric_shear<T: Scalar>(p: &mut SMatrix<T, 4, 4>, axis: usize, a: T) {
    let mut f = SMatrix::<T, 4, 4>::identity();
    f[(axis, axis + 2)] = a;
    *p = f * *p * f.transpose();
    mirror(p);
}

fn mirror<T: Scalar>(p: &mut SMatrix<T, 4, 4>) {
    for i in 0..4 {
        for j in 0..i {
            p[(j, i)] = p[(i, j)];
        }
    }
}

/// (P hᵀ, k) of a row, or `None` if S is not positive.
fn gain<T: Scalar>(p: &SMatrix<T, 4, 4>, h: [T; 4], r: T) -> Option<[[T; 4]; 2]> {
    let g: [T; 4] = std::array::from_fn(|i| T::dot(&h, &std::array::from_fn(|j| p[(i, j)])));
    let s = T::dot(&h, &g) + r;
    (s > T::ZERO).then(|| [g, g.map(|g| g / s)])
}

impl<T: Scalar> Form<T> for Conventional<T> {
    const NAME: &'static str = "conventional";
    fn new(variances: [T; 4]) -> Self {
        Self(SMatrix::from_diagonal(&SVector::from(variances)))
    }
    fn shear(&mut self, axis: usize, a: T) {
        symmetric_shear(&mut self.0, axis, a);
    }
    fn add_variance(&mut self, state: usize, q: T) {
        self.0[(state, state)] += q;
    }
    fn update(&mut self, h: [T; 4], r: T) -> bool {
        let Some([g, k]) = gain(&self.0, h, r) else { return false };
        self.0 = SMatrix::from_fn(|i, j| self.0[(i, j)] - k[i] * g[j]);
        mirror(&mut self.0);
        true
    }
    fn matrix(&self) -> Matrix4<f64> {
        doubles(&self.0)
    }
}

impl<T: Scalar> Form<T> for Joseph<T> {
    const NAME: &'static str = "Joseph";
    fn new(variances: [T; 4]) -> Self {
        Self(SMatrix::from_diagonal(&SVector::from(variances)))
    }
    fn shear(&mut self, axis: usize, a: T) {
        symmetric_shear(&mut self.0, axis, a);
    }
    fn add_variance(&mut self, state: usize, q: T) {
        self.0[(state, state)] += q;
    }
    fn update(&mut self, h: [T; 4], r: T) -> bool {
        let Some([g, k]) = gain(&self.0, h, r) else { return false };
        let half: SMatrix<T, 4, 4> = SMatrix::from_fn(|i, j| self.0[(i, j)] - k[i] * g[j]);
        let seen: [T; 4] =
            std::array::from_fn(|i| T::dot(&h, &std::array::from_fn(|j| half[(i, j)])));
        self.0 = SMatrix::from_fn(|i, j| half[(i, j)] - seen[i] * k[j] + (r * k[i]) * k[j]);
        mirror(&mut self.0);
        true
    }
    fn matrix(&self) -> Matrix4<f64> {
        doubles(&self.0)
    }
}

/// The UD form P = U D Uᵀ: Bierman's update, Agee and Turner's rank-one sum (Bierman 1977).
pub(crate) struct Ud<T: Scalar> {
    u: SMatrix<T, 4, 4>,
    d: [T; 4],
}

impl<T: Scalar> Form<T> for Ud<T> {
    const NAME: &'static str = "UD";
    fn new(variances: [T; 4]) -> Self {
        Self { u: SMatrix::identity(), d: variances }
    }
    fn shear(&mut self, axis: usize, a: T) {
        for k in axis + 2..4 {
            let moved = a * self.u[(axis + 2, k)];
            self.u[(axis, k)] += moved;
        }
    }
    fn add_variance(&mut self, state: usize, q: T) {
        let mut x = [T::ZERO; 4];
        x[state] = T::ONE;
        let mut c = q;
        for j in (0..=state).rev() {
            let sum = self.d[j] + c * x[j] * x[j];
            if sum <= T::ZERO {
                continue;
            }
            let beta = c / sum * x[j];
            c *= self.d[j] / sum;
            for k in 0..j {
                x[k] -= x[j] * self.u[(k, j)];
                self.u[(k, j)] += beta * x[k];
            }
            self.d[j] = sum;
        }
    }
    fn update(&mut self, h: [T; 4], r: T) -> bool {
        let f: [T; 4] =
            std::array::from_fn(|j| T::dot(&h, &std::array::from_fn(|i| self.u[(i, j)])));
        let (mut alpha, mut b) = (r, [T::ZERO; 4]);
        for j in 0..4 {
            let (before, g) = (alpha, self.d[j] * f[j]);
            alpha += f[j] * g;
            if alpha <= T::ZERO {
                return false;
            }
            self.d[j] *= before / alpha;
            let lambda = -(f[j] / before);
            for i in 0..j {
                let u = self.u[(i, j)];
                self.u[(i, j)] = u + b[i] * lambda;
                b[i] += u * g;
            }
            b[j] = g;
        }
        true
    }
    fn matrix(&self) -> Matrix4<f64> {
        let (u, d) = (doubles(&self.u), Vector4::from(self.d.map(T::to_f64)));
        u * Matrix4::from_diagonal(&d) * u.transpose()
    }
}
