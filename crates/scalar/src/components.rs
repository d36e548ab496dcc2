use nalgebra::{SMatrix, SVector};

/// The components of a column vector as an array of a size known at compile time.
///
/// nalgebra's own indexing, `v[i]`, keeps a bounds check, and with it a panic, wherever the compiler
/// does not know `i`. It knows the length of an array, so loops over `0..N` need neither. Nothing is
/// copied, and the call leaves no code on the target. A `const fn` cannot call a trait, and must read the field
/// `data.0` itself.
///
/// ```
/// use kestirim_scalar::Components;
/// use nalgebra::Vector3;
///
/// let mut force = Vector3::new(0.0, 0.0, 9.81);
/// let [x, _, z] = *force.as_array();
/// assert_eq!((x, z), (0.0, 9.81));
/// force.as_array_mut()[0] = 1.0;
/// assert_eq!(force.x, 1.0);
/// ```
pub trait Components<T, const N: usize> {
    /// The N components.
    fn as_array(&self) -> &[T; N];
    /// The N components, to be changed in place.
    fn as_array_mut(&mut self) -> &mut [T; N];
}

impl<T, const N: usize> Components<T, N> for SVector<T, N> {
    #[inline(always)]
    fn as_array(&self) -> &[T; N] {
        let [components] = &self.data.0;
        components
    }

    #[inline(always)]
    fn as_array_mut(&mut self) -> &mut [T; N] {
        let [components] = &mut self.data.0;
        components
    }
}

/// The columns of a matrix as arrays of a size known at compile time: `m.as_columns()[column][row]`.
///
/// See [`Components`] for why to use it instead of indexing.
///
/// ```
/// use kestirim_scalar::Columns;
/// use nalgebra::Matrix2;
///
/// let mut m = Matrix2::new(1.0, 2.0, 3.0, 4.0);
/// assert_eq!(m.as_columns(), &[[1.0, 3.0], [2.0, 4.0]]);
/// m.as_columns_mut()[1][0] = 0.0;
/// assert_eq!(m, Matrix2::new(1.0, 0.0, 3.0, 4.0));
/// ```
pub trait Columns<T, const R: usize, const C: usize> {
    /// The C columns of R entries each.
    fn as_columns(&self) -> &[[T; R]; C];
    /// The C columns of R entries each, to be changed in place.
    fn as_columns_mut(&mut self) -> &mut [[T; R]; C];
}

impl<T, const R: usize, const C: usize> Columns<T, R, C> for SMatrix<T, R, C> {
    #[inline(always)]
    fn as_columns(&self) -> &[[T; R]; C] {
        &self.data.0
    }

    #[inline(always)]
    fn as_columns_mut(&mut self) -> &mut [[T; R]; C] {
        &mut self.data.0
    }
}
