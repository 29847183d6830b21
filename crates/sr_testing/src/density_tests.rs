//! What must hold of every density that is chosen at run time.

use sr_integrate::{Columns, ColumnsMut, Density, DensityError, Space};
use sr_stats::chi2::blocks::{self, Blocks};
use sr_stats::{Chi2Settings, TestReport};

/// A density as the chi-square test sees it.
struct AsBlocks<'a>(&'a dyn Density);

impl Blocks for AsBlocks<'_> {
    type Error = DensityError;

    fn dim(&self) -> usize {
        self.0.space().dim()
    }

    fn uniforms(&self) -> usize {
        self.0.uniforms()
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.0.support()
    }

    fn sample(&mut self, u: &[f64], x: &mut [f64], pdf: &mut [f64]) -> Result<(), DensityError> {
        let n = pdf.len();
        self.0.sample(Columns::new(u, n), ColumnsMut::new(x, n), pdf)
    }

    fn pdf(&mut self, x: &[f64], pdf: &mut [f64]) -> Result<(), DensityError> {
        self.0.pdf(Columns::new(x, pdf.len()), pdf)
    }
}

/// Do the samples follow the density?
///
/// # Panics
/// If the density is one of surface area, whose surface is not known, or fails.
pub fn chi2(density: &dyn Density, settings: Chi2Settings) -> TestReport {
    let mut blocks = AsBlocks(density);
    let report = match density.space() {
        Space::SolidAngle => blocks::directions(&mut blocks, settings),
        Space::Counting => {
            let len = density.support()[0][1] as usize + 1;
            blocks::indices(&mut blocks, len, settings)
        }
        Space::Line | Space::Plane | Space::Volume(_) => blocks::real(&mut blocks, settings),
        Space::Area => panic!("a density of surface area has no coordinates"),
    };
    report.expect("densities of this project do not fail")
}

/// Samples of a density.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The uniforms, column after column.
    pub u: Vec<f64>,
    /// The points, column after column.
    pub x: Vec<f64>,
    /// The densities that the samples carry.
    pub pdf: Vec<f64>,
}

impl Drawn {
    /// Draws a point from each of some rows of uniforms, column after column.
    ///
    /// # Panics
    /// If the density fails.
    pub fn new(density: &dyn Density, u: Vec<f64>) -> Self {
        let n = u.len() / density.uniforms();
        let (mut x, mut pdf) = (vec![0.0; n * density.space().dim()], vec![0.0; n]);
        let outcome = density.sample(Columns::new(&u, n), ColumnsMut::new(&mut x, n), &mut pdf);
        outcome.expect("densities of this project do not fail");
        Self { u, x, pdf }
    }

    /// `n` points from independent uniforms of 53 bits.
    ///
    /// # Panics
    /// As [`Drawn::new`].
    pub fn independent(density: &dyn Density, n: usize, seed: u64) -> Self {
        let mut u = vec![0.0; n * density.uniforms()];
        let sequence =
            sr_integrate::Points::new(sr_integrate::Sequence::Independent, density.uniforms(), seed);
        sequence.fill(0, 0, ColumnsMut::new(&mut u, n));
        Self::new(density, u)
    }

    /// The points.
    pub fn points(&self) -> Columns<'_> {
        Columns::new(&self.x, self.pdf.len())
    }

    /// The uniforms.
    pub fn uniforms(&self) -> Columns<'_> {
        Columns::new(&self.u, self.pdf.len())
    }
}
