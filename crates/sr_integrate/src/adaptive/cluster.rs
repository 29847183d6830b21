//! Where points crowd: mixtures of normal densities, fitted by expectation maximisation.
//!
//! (A. Dempster, N. Laird & D. Rubin, J. R. Stat. Soc. B 39, 1977; seeds as in k-means++, D. Arthur & S. Vassilvitskii,
//! SODA 2007; their number by the Bayesian information criterion, G. Schwarz, Ann. Stat. 6, 1978.)

use sr_sampling::sequence::mix::{derive_key, mix64};

use super::matrix::cholesky;

/// A normal density in a mixture.
#[derive(Clone, Debug)]
pub struct Cluster {
    /// Its weight.
    pub share: f64,
    /// Its centre.
    pub mean: Vec<f64>,
    /// d × d, row after row.
    pub covariance: Vec<f64>,
}

/// Points with weights: rows of `dim` numbers.
pub struct Cloud {
    pub dim: usize,
    pub points: Vec<f64>,
    /// Sum to the number of points that the cloud is worth.
    pub weights: Vec<f64>,
}

impl Cloud {
    fn len(&self) -> usize {
        self.weights.len()
    }

    fn point(&self, i: usize) -> &[f64] {
        &self.points[i * self.dim..(i + 1) * self.dim]
    }

    fn total(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// The variance along each axis; never 0.
    fn variances(&self) -> Vec<f64> {
        let (dim, total) = (self.dim, self.total());
        (0..dim)
            .map(|j| {
                let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
                    (0..self.len()).map(|i| self.weights[i] * f(self.point(i)[j])).sum::<f64>() / total
                };
                let mean = sum(&|x| x);
                sum(&|x| (x - mean) * (x - mean)).max(1e-24)
            })
            .collect()
    }
}

/// The clusters of a cloud: as many, up to `most`, as the criterion asks for.
pub fn clusters(cloud: &Cloud, most: usize, key: u64) -> Vec<Cluster> {
    let variances = cloud.variances();
    let mut best: Option<(f64, Vec<Cluster>)> = None;
    let mut worse = 0;
    let parameters = |count: usize| count * (1 + cloud.dim + cloud.dim * (cloud.dim + 1) / 2);
    let known =
        |count: &usize| *count <= most && (*count == 1 || 2 * parameters(*count) < cloud.total() as usize);
    for count in [1, 2, 3, 5, 8, 12, 18, 24].into_iter().take_while(known) {
        let (fit, found) = fit(cloud, count, &variances, derive_key(key, count as u32));
        let merit = fit - 0.5 * parameters(found.len()) as f64 * cloud.total().max(2.0).ln();
        if best.as_ref().is_none_or(|(known, _)| merit > *known) {
            (best, worse) = (Some((merit, found)), 0);
        } else {
            worse += 1;
            if worse == 2 {
                break;
            }
        }
    }
    best.map(|(_, found)| found).unwrap_or_default()
}

/// Fits `count` clusters, or fewer if some starve; with the logarithm of the likelihood.
fn fit(cloud: &Cloud, count: usize, variances: &[f64], key: u64) -> (f64, Vec<Cluster>) {
    let (dim, n) = (cloud.dim, cloud.len());
    let mut shares = nearest(cloud, &seeds(cloud, count, variances, key), variances);
    let mut last = f64::NEG_INFINITY;
    let mut found = Vec::new();
    for _ in 0..10 {
        found = shares.iter().filter_map(|share| cluster(cloud, share, variances)).collect::<Vec<Cluster>>();
        let total: f64 = found.iter().map(|cluster| cluster.share).sum();
        found.iter_mut().for_each(|cluster| cluster.share /= total);
        let mut logs: Vec<Vec<f64>> = found.iter().map(|cluster| log_densities(cloud, cluster)).collect();
        let mut likelihood = 0.0;
        for i in 0..n {
            let top = logs.iter().map(|log| log[i]).fold(f64::NEG_INFINITY, f64::max);
            let mut sum = 0.0;
            for log in &mut logs {
                let below = log[i] - top;
                log[i] = if below > -30.0 { below.exp() } else { 0.0 };
                sum += log[i];
            }
            logs.iter_mut().for_each(|log| log[i] *= cloud.weights[i] / sum);
            likelihood += cloud.weights[i] * (top + sum.ln());
        }
        shares = logs;
        let done = likelihood - last < 1e-3 * cloud.total() * dim as f64;
        last = likelihood;
        if done || found.len() == 1 {
            break;
        }
    }
    (last, found)
}

/// Points of the cloud, far from one another.
fn seeds(cloud: &Cloud, count: usize, variances: &[f64], key: u64) -> Vec<Vec<f64>> {
    let mut seeds: Vec<Vec<f64>> = Vec::new();
    let mut away = cloud.weights.clone();
    for k in 0..count {
        let total: f64 = away.iter().sum();
        let mut goal = total * (mix64(derive_key(key, k as u32)) as f64 / u64::MAX as f64);
        let found = away.iter().position(|weight| {
            goal -= weight;
            goal <= 0.0
        });
        let seed = cloud.point(found.unwrap_or(0)).to_vec();
        for (i, away) in away.iter_mut().enumerate() {
            let far = cloud.weights[i] * distance(cloud.point(i), &seed, variances);
            *away = if k == 0 { far } else { away.min(far) };
        }
        seeds.push(seed);
    }
    seeds
}

/// Squared, in units of the cloud's spread.
fn distance(a: &[f64], b: &[f64], variances: &[f64]) -> f64 {
    a.iter().zip(b).zip(variances).map(|((a, b), variance)| (a - b) * (a - b) / variance).sum()
}

/// The weights of the points that are nearest to each centre, after a few steps of Lloyd's.
fn nearest(cloud: &Cloud, seeds: &[Vec<f64>], variances: &[f64]) -> Vec<Vec<f64>> {
    let mut centres = seeds.to_vec();
    let mut shares = Vec::new();
    for _ in 0..4 {
        shares = vec![vec![0.0; cloud.len()]; centres.len()];
        for i in 0..cloud.len() {
            let far: Vec<f64> = centres.iter().map(|c| distance(cloud.point(i), c, variances)).collect();
            let closest = (0..far.len()).min_by(|&a, &b| far[a].total_cmp(&far[b])).unwrap_or(0);
            shares[closest][i] = cloud.weights[i];
        }
        for (centre, share) in centres.iter_mut().zip(&shares) {
            let total: f64 = share.iter().sum();
            if total > 0.0 {
                for (j, x) in centre.iter_mut().enumerate() {
                    *x = share.iter().enumerate().map(|(i, w)| w * cloud.point(i)[j]).sum::<f64>() / total;
                }
            }
        }
    }
    shares
}

/// The cluster of points that are its own by `share`; nothing if these are too few.
fn cluster(cloud: &Cloud, share: &[f64], variances: &[f64]) -> Option<Cluster> {
    let dim = cloud.dim;
    let total: f64 = share.iter().sum();
    if !(total > 3.0) {
        return None;
    }
    let mut mean = vec![0.0; dim];
    for (i, w) in share.iter().enumerate() {
        mean.iter_mut().zip(cloud.point(i)).for_each(|(mean, x)| *mean += w / total * x);
    }
    let mut covariance = vec![0.0; dim * dim];
    let mut away = vec![0.0; dim];
    for (i, &w) in share.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        away.iter_mut().zip(cloud.point(i)).zip(&mean).for_each(|((away, x), mean)| *away = x - mean);
        for a in 0..dim {
            let factor = w * away[a];
            for b in 0..=a {
                covariance[a * dim + b] += factor * away[b];
            }
        }
    }
    // Few points know little of correlations; and no cluster is flat.
    let sure = (total / (5.0 * dim as f64)).min(1.0);
    for a in 0..dim {
        for b in 0..a {
            let sum = covariance[a * dim + b] / total * sure;
            (covariance[a * dim + b], covariance[b * dim + a]) = (sum, sum);
        }
        covariance[a * dim + a] =
            (covariance[a * dim + a] + 1e-3 * variances[a]) / total + 1e-9 * variances[a];
    }
    Some(Cluster { share: total, mean, covariance })
}

/// ln(share · density) at each point.
fn log_densities(cloud: &Cloud, cluster: &Cluster) -> Vec<f64> {
    let dim = cloud.dim;
    let lower = cholesky(&cluster.covariance, dim).unwrap_or_else(|| {
        (0..dim * dim).map(|i| if i / dim == i % dim { cluster.covariance[i].sqrt() } else { 0.0 }).collect()
    });
    let determinant: f64 = (0..dim).map(|j| lower[j * dim + j].ln()).sum();
    let constant = cluster.share.ln() - determinant - 0.5 * dim as f64 * std::f64::consts::TAU.ln();
    let mut z = vec![0.0; dim];
    (0..cloud.len())
        .map(|i| {
            let x = cloud.point(i);
            let mut square = 0.0;
            for a in 0..dim {
                let known: f64 = lower[a * dim..a * dim + a].iter().zip(&z).map(|(l, z)| l * z).sum();
                z[a] = (x[a] - cluster.mean[a] - known) / lower[a * dim + a];
                square += z[a] * z[a];
            }
            constant - 0.5 * square
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(i: usize) -> f64 {
        mix64(i as u64 * 77 + 5) as f64 / u64::MAX as f64
    }

    /// About normal: the sum of four uniforms.
    fn noise(i: usize) -> f64 {
        (0..4).map(|k| uniform(4 * i + k)).sum::<f64>() - 2.0
    }

    #[test]
    fn crowds_are_found() {
        let centres = [[0.2, 0.2], [0.8, 0.7], [0.2, 0.9]];
        let mut points = Vec::new();
        for i in 0..600 {
            let c = centres[i % 3];
            points.extend([c[0] + 0.05 * noise(2 * i), c[1] + 0.02 * noise(2 * i + 1)]);
        }
        let found = clusters(&Cloud { dim: 2, points, weights: vec![1.0; 600] }, 8, 3);
        assert_eq!(found.len(), 3);
        for centre in centres {
            let near = |c: &&Cluster| (c.mean[0] - centre[0]).abs() + (c.mean[1] - centre[1]).abs() < 0.02;
            let cluster = found.iter().find(near).unwrap();
            assert!((cluster.share - 1.0 / 3.0).abs() < 0.01);
            assert!((cluster.covariance[0].sqrt() / (0.05 / 3_f64.sqrt()) - 1.0).abs() < 0.15, "{cluster:?}");
        }
    }

    #[test]
    fn one_crowd_is_one() {
        let points: Vec<f64> = (0..1500).map(noise).collect();
        assert_eq!(clusters(&Cloud { dim: 3, points, weights: vec![1.0; 500] }, 8, 1).len(), 1);
    }

    #[test]
    fn a_ridge_is_correlated() {
        let points: Vec<f64> =
            (0..400).flat_map(|i| [uniform(i), uniform(i) + 0.001 * noise(i + 1000)]).collect();
        let found = clusters(&Cloud { dim: 2, points, weights: vec![1.0; 400] }, 1, 1);
        let c = &found[0].covariance;
        assert!(c[1] / (c[0] * c[3]).sqrt() > 0.99, "{c:?}");
    }
}
