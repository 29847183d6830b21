//! Small symmetric matrices, row after row: what clusters and their frames need.

/// The lower triangle L of L Lᵀ, or nothing if the matrix is not positive definite.
pub fn cholesky(matrix: &[f64], d: usize) -> Option<Vec<f64>> {
    let mut lower = vec![0.0; d * d];
    for i in 0..d {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i * d + k] * lower[j * d + k]).sum();
            let rest = matrix[i * d + j] - known;
            lower[i * d + j] = if i > j {
                rest / lower[j * d + j]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(lower)
}

/// An orthonormal matrix whose columns are the eigenvectors, by Jacobi's rotations.
pub fn eigenvectors(matrix: &[f64], d: usize) -> Vec<f64> {
    let mut a = matrix.to_vec();
    let mut vectors: Vec<f64> = (0..d * d).map(|i| if i / d == i % d { 1.0 } else { 0.0 }).collect();
    for _ in 0..30 {
        let mut rotated = false;
        for p in 0..d {
            for q in p + 1..d {
                let off = a[p * d + q];
                if off.abs() <= 1e-14 * (a[p * d + p] * a[q * d + q]).abs().sqrt() {
                    continue;
                }
                rotated = true;
                let theta = 0.5 * (a[q * d + q] - a[p * d + p]) / off;
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..d {
                    let (x, y) = (a[k * d + p], a[k * d + q]);
                    (a[k * d + p], a[k * d + q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..d {
                    let (x, y) = (a[p * d + k], a[q * d + k]);
                    (a[p * d + k], a[q * d + k]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (vectors[k * d + p], vectors[k * d + q]);
                    (vectors[k * d + p], vectors[k * d + q]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
        if !rotated {
            break;
        }
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_its_factor_squared() {
        let matrix = [4.0, 2.0, 0.4, 2.0, 3.0, 0.5, 0.4, 0.5, 1.0];
        let lower = cholesky(&matrix, 3).unwrap();
        for i in 0..9 {
            let product: f64 = (0..3).map(|k| lower[i / 3 * 3 + k] * lower[i % 3 * 3 + k]).sum();
            assert!((product - matrix[i]).abs() < 1e-12);
        }
        assert_eq!(cholesky(&[1.0, 2.0, 2.0, 1.0], 2), None);
    }

    #[test]
    fn eigenvectors_make_it_diagonal() {
        let matrix = [4.0, 2.0, 0.4, 2.0, 3.0, 0.5, 0.4, 0.5, 1.0];
        let v = eigenvectors(&matrix, 3);
        for a in 0..3 {
            for b in 0..3 {
                let dot: f64 = (0..3).map(|k| v[k * 3 + a] * v[k * 3 + b]).sum();
                assert!((dot - if a == b { 1.0 } else { 0.0 }).abs() < 1e-12);
                let form: f64 = (0..9).map(|i| v[i / 3 * 3 + a] * matrix[i] * v[i % 3 * 3 + b]).sum();
                assert!(a == b || form.abs() < 1e-10, "{form}");
            }
        }
    }
}
