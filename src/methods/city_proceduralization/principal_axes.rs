//! Principal axes of points.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The axes of the greatest variance, at most `most`, of points that are the columns of a centred `table`; `covariance` is theirs,
/// up to a factor. Eigenvectors are the axes; on some matrices of rank one, such as those of two height maps of zeros and
/// ones, the iteration of nalgebra divides zero by zero, and the singular vectors of the table are taken.
pub(super) fn principal_axes(
    covariance: DMatrix<f64>,
    table: &DMatrix<f64>,
    most: usize,
) -> Vec<DVector<f64>> {
    let eigen = SymmetricEigen::new(covariance);
    let is_sound = |values: &[f64]| values.iter().all(|v| v.is_finite());
    if is_sound(eigen.eigenvalues.as_slice()) && is_sound(eigen.eigenvectors.as_slice()) {
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        order.truncate(most);
        let axes = order.into_iter();
        return axes.map(|k| eigen.eigenvectors.column(k).into()).collect();
    }
    let vectors = table.clone().svd(true, false).u;
    let axes = vectors.iter().flat_map(|u| u.column_iter().take(most));
    axes.map(Into::into).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distances along the axes are those of the points, as no direction in which they differ is lost.
    fn assert_kept(table: &DMatrix<f64>) {
        let covariance = table * table.transpose();
        let axes = principal_axes(covariance, table, 12);
        let along = |i: usize| axes.iter().map(move |a| a.dot(&table.column(i)));
        for i in 0..table.ncols() {
            for j in 0..i {
                let apart: f64 = along(i).zip(along(j)).map(|(a, b)| (a - b).powi(2)).sum();
                let own = (table.column(i) - table.column(j)).norm_squared();
                assert!((apart - own).abs() < 1e-9 * own.max(1.0), "{apart} {own}");
            }
        }
    }

    #[test]
    fn maps_of_zeros_and_ones_have_axes() {
        let side = 16_usize;
        let corner =
            |x: usize, y: usize, cut: usize| match x + y < cut || x + y > 2 * side - 2 - cut {
                true => 0.0,
                false => 1.0,
            };
        for cut in 0..side {
            for other in 0..side {
                let cuts = [cut, other];
                let mean = |i: usize| {
                    cuts.map(|c| corner(i % side, i / side, c))
                        .iter()
                        .sum::<f64>()
                        / 2.0
                };
                let table = DMatrix::from_fn(side * side, 2, |i, j| {
                    corner(i % side, i / side, cuts[j]) - mean(i)
                });
                assert_kept(&table);
            }
        }
    }
}
