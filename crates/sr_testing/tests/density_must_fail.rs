//! Densities that are wrong on purpose. The test of those that are chosen at run time has to reject each of
//! them.

use std::fmt;
use std::sync::Arc;

use sr_integrate::distributions::{
    Cone, Cosine, Discrete, Disk, Linear, Mixture, Normal, Product, Tabulated2D, UniformBox, Zonal,
};
use sr_integrate::{Columns, ColumnsMut, Density, DensityError, Space};
use sr_stats::{Chi2Settings, ks};
use sr_testing::density_tests::{Drawn, chi2};

/// No right density among a million would be rejected at this level.
const LEVEL: f64 = 1e-9;

const SETTINGS: Chi2Settings = Chi2Settings { samples: 1 << 16, bins: (16, 16), seed: 9 };

/// The samples of one density, moved, and claimed to follow another.
struct Claim {
    samples: Arc<dyn Density>,
    moved: fn(&mut [f64]),
    density: Arc<dyn Density>,
    claimed: fn(&[f64], f64) -> f64,
}

impl fmt::Debug for Claim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} said to follow {:?}", self.samples, self.density)
    }
}

impl Density for Claim {
    fn space(&self) -> Space {
        self.density.space()
    }

    fn uniforms(&self) -> usize {
        self.samples.uniforms()
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.samples.sample(u, x.reborrow(), pdf)?;
        for i in 0..u.len() {
            let mut point = x.as_columns().point(i);
            (self.moved)(&mut point);
            x.write(i, &point);
        }
        self.pdf(x.as_columns(), pdf)?;
        // Something was drawn, also where the density says that nothing is.
        pdf.iter_mut().for_each(|pdf| *pdf = pdf.max(1e-300));
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.density.pdf(x, pdf)?;
        for (i, pdf) in pdf.iter_mut().enumerate() {
            *pdf = (self.claimed)(&x.point(i), *pdf);
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.density.support()
    }
}

/// One density of each kind of space.
fn right() -> Vec<Arc<dyn Density>> {
    vec![
        Arc::new(Linear::new(0.0, 5.0, 0.0, 1.0).expect("a line")),
        Arc::new(Normal::new(0.0, 1.0).expect("a normal")),
        Arc::new(Disk::new(1.0).expect("a disk")),
        Arc::new(UniformBox::new(&[[0.0, 1.0]; 4]).expect("a box")),
        Arc::new(Zonal::new(Cosine, [0.0, 0.0, 1.0]).expect("a hemisphere")),
        Arc::new(Discrete::new(&[1.0, 2.0, 3.0, 4.0]).expect("weights")),
    ]
}

fn claim(samples: &Arc<dyn Density>, claimed: fn(&[f64], f64) -> f64) -> Claim {
    Claim { samples: samples.clone(), moved: |_| {}, density: samples.clone(), claimed }
}

#[track_caller]
fn rejected(density: &dyn Density) {
    let report = chi2(density, SETTINGS);
    assert!(!report.passes(LEVEL), "{density:?} is not rejected: {report}");
}

/// The wrapper itself is not what is rejected.
#[test]
fn honest_claims_pass() {
    for density in right() {
        let report = chi2(&claim(&density, |_, p| p), SETTINGS);
        assert!(report.passes(1e-3), "{density:?}: {report}");
    }
}

#[test]
fn a_scaled_pdf() {
    for density in right() {
        rejected(&claim(&density, |_, p| 1.03 * p));
        rejected(&claim(&density, |_, p| 0.97 * p));
    }
}

#[test]
fn a_hole_in_the_support() {
    for density in right().iter().take(5) {
        rejected(&claim(density, |x, p| if x[0] > 0.6 && x[0] < 0.65 { 0.0 } else { p }));
    }
    rejected(&claim(&right()[5], |x, p| if x[0] == 1.0 { 0.0 } else { p }));
}

#[test]
fn a_density_that_is_not_a_number() {
    for density in right() {
        rejected(&claim(&density, |_, _| f64::NAN));
        rejected(&claim(&density, |x, p| if x[0] > 0.7 { f64::INFINITY } else { p }));
        rejected(&claim(&density, |x, p| if x[0] > 0.7 { -p } else { p }));
    }
}

/// Stretched samples with the density of the others.
#[test]
fn a_missing_jacobian() {
    for density in right().iter().take(4) {
        let stretched = Claim {
            moved: |x| x[0] *= 1.1,
            density: Arc::new(Inverted(density.clone())),
            ..claim(density, |_, p| p)
        };
        rejected(&stretched);
    }
}

/// A density at x / 1.1 along the first axis, without the factor that belongs to it.
#[derive(Debug)]
struct Inverted(Arc<dyn Density>);

impl Density for Inverted {
    fn space(&self) -> Space {
        self.0.space()
    }

    fn uniforms(&self) -> usize {
        self.0.uniforms()
    }

    fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.0.sample(u, x, pdf)
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut numbers = x.numbers().to_vec();
        numbers[..x.len()].iter_mut().for_each(|x| *x /= 1.1);
        self.0.pdf(Columns::new(&numbers, x.len()), pdf)
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.0.support().into_iter().map(|[low, high]| [1.1 * low, 1.1 * high]).collect()
    }
}

#[test]
fn swapped_axes() {
    let line = |at_low, at_high| Arc::new(Linear::new(0.0, 1.0, at_low, at_high).expect("a line"));
    let product: Arc<dyn Density> =
        Arc::new(Product::new(vec![line(1.0, 1.2), line(1.0, 1.0), line(1.0, 1.0)]).expect("factors"));
    rejected(&Claim { moved: |x| x.swap(0, 2), ..claim(&product, |_, p| p) });
    let table: Arc<dyn Density> =
        Arc::new(Tabulated2D::new(&[1.0, 1.0, 2.0, 1.0], [2, 2], [0.0; 2], [1.0; 2]).expect("a table"));
    rejected(&Claim { moved: |x| x.swap(0, 1), ..claim(&table, |_, p| p) });
    let lobe: Arc<dyn Density> = Arc::new(Zonal::new(Cone::HEMISPHERE, [1.0, 0.0, 0.0]).expect("a cone"));
    rejected(&Claim { moved: |x| x.swap(0, 1), ..claim(&lobe, |_, p| p) });
}

#[test]
fn samples_of_another_density() {
    let uniform: Arc<dyn Density> = Arc::new(Zonal::new(Cone::HEMISPHERE, [0.0, 0.0, 1.0]).expect("a cone"));
    rejected(&Claim { density: right()[4].clone(), ..claim(&uniform, |_, p| p) });
    let wider: Arc<dyn Density> = Arc::new(Normal::new(0.0, 1.05).expect("a normal"));
    rejected(&Claim { density: right()[1].clone(), ..claim(&wider, |_, p| p) });
    // The density of the component that was drawn, not of the mixture.
    let component =
        |low, high| Arc::new(Linear::new(low, high, 1.0, 1.0).expect("a line")) as Arc<dyn Density>;
    let parts = vec![component(0.0, 1.0), component(0.0, 2.0)];
    let mixture: Arc<dyn Density> = Arc::new(Mixture::new(parts, vec![0.5, 0.5]).expect("weights"));
    rejected(&claim(&mixture, |x, _| if x[0] < 1.0 { 1.0 } else { 0.5 }));
}

#[test]
fn a_wrong_distribution_function() {
    let normal = Normal::new(0.0, 1.0).expect("a normal");
    let drawn = Drawn::independent(&normal, 1 << 16, 1);
    let cumulative = Density::cumulative(&normal).expect("it has one");
    assert!(ks(&drawn.x, |x| cumulative.cdf(x)).passes(1e-3));
    assert!(!ks(&drawn.x, |x| cumulative.cdf(x + 0.03)).passes(LEVEL));
}
