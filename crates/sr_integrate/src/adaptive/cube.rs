//! A density on the unit cube: a mixture of products along axes, whose uniforms may come from strata.

use super::component::Component;
use super::strata::Strata;
use crate::columns::{Columns, ColumnsMut};

/// Shares of components are multiples of 1 / 64. The first uniform chooses the component and is stretched to be used
/// again; those points of a Sobol' net that choose a share of so many 64ths are nets themselves.
pub const PARTS: u32 = 64;

/// The largest number below 1: the cube has no upper faces.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// A mixture of [`Component`]s. Where one of them leaves the cube, nothing is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeDensity {
    components: Vec<Component>,
    /// Of each component, in [`PARTS`].
    shares: Vec<u32>,
    /// What the uniforms of the mixture are drawn from; the one that chooses the component is among them.
    strata: Option<Strata>,
}

impl CubeDensity {
    /// The constant density.
    pub fn uniform(dim: usize) -> Self {
        Self::single(Component::uniform(dim))
    }

    /// One component.
    pub fn single(component: Component) -> Self {
        Self { components: vec![component], shares: vec![PARTS], strata: None }
    }

    /// Components with shares in proportion to weights, rounded; those that round to none are left out.
    ///
    /// # Panics
    /// If no weight is positive.
    pub fn mixture(components: Vec<Component>, weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        assert!(total > 0.0, "a mixture of nothing");
        let exact: Vec<f64> = weights.iter().map(|w| w / total * f64::from(PARTS)).collect();
        let mut shares: Vec<u32> = exact.iter().map(|w| w.round() as u32).collect();
        while shares.iter().sum::<u32>() != PARTS {
            let all: u32 = shares.iter().sum();
            let error = |i: &usize| f64::from(shares[*i]) - exact[*i];
            let worst = |a: &usize, b: &usize| error(a).total_cmp(&error(b));
            let all_of = 0..shares.len();
            match all > PARTS {
                true => all_of.max_by(worst).into_iter().for_each(|i| shares[i] -= 1),
                false => all_of.min_by(worst).into_iter().for_each(|i| shares[i] += 1),
            }
        }
        let mut kept: Vec<(Component, u32)> =
            components.into_iter().zip(shares).filter(|&(_, share)| share > 0).collect();
        // Large shares first, so that they are aligned with the net.
        kept.sort_by_key(|&(_, share)| std::cmp::Reverse(share));
        let (components, shares) = kept.into_iter().unzip();
        Self { components, shares, strata: None }
    }

    /// Components with their shares, which sum to [`PARTS`].
    pub(super) fn from_shares(components: Vec<Component>, shares: Vec<u32>) -> Self {
        Self { components, shares, strata: None }
    }

    /// The same mixture of uniforms from `strata`, in place of those that it had.
    pub fn with_strata(&self, strata: Strata) -> Self {
        Self { strata: Some(strata), ..self.clone() }
    }

    /// What its uniforms are drawn from, if not evenly.
    pub fn strata(&self) -> Option<&Strata> {
        self.strata.as_ref()
    }

    /// Of each component, in [`PARTS`].
    pub fn shares(&self) -> &[u32] {
        &self.shares
    }

    /// The number of coordinates, and of uniforms that a sample consumes.
    pub fn dim(&self) -> usize {
        self.components[0].axes().len()
    }

    /// What it is a mixture of.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// The probability of each component.
    pub fn weights(&self) -> Vec<f64> {
        self.shares.iter().map(|&share| f64::from(share) / f64::from(PARTS)).collect()
    }

    /// Draws a point from each row of `u`, with its density; 0 where nothing is drawn.
    pub fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) {
        let mut density = vec![1.0; u.len()];
        let Some(strata) = &self.strata else {
            return self.mix(u, &density, x, pdf);
        };
        let mut drawn = u.numbers().to_vec();
        strata.sample(ColumnsMut::new(&mut drawn, u.len()), &mut density);
        self.mix(Columns::new(&drawn, u.len()), &density, x, pdf);
    }

    /// [`CubeDensity::sample`] from uniforms that are drawn from the strata, whose density there is known.
    pub(super) fn mix(&self, u: Columns<'_>, density: &[f64], mut x: ColumnsMut<'_>, pdf: &mut [f64]) {
        if let [component] = &self.components[..] {
            component.sample(u, x.reborrow(), pdf);
            if self.strata.is_some() {
                pdf.iter_mut().zip(density).for_each(|(pdf, density)| *pdf *= density);
            }
            to_cube(component, x, pdf);
            return;
        }
        let dim = self.dim();
        for (k, component) in self.components.iter().enumerate() {
            let [low, high] = self.slice(k);
            let rows: Vec<usize> = u
                .column(0)
                .iter()
                .enumerate()
                .filter(|(_, u)| (low..high).contains(u))
                .map(|(i, _)| i)
                .collect();
            let n = rows.len();
            if n == 0 {
                continue;
            }
            let stretch = 1.0 / (high - low);
            let mut own = Vec::with_capacity(n * dim);
            own.extend(rows.iter().map(|&i| ((u.get(i, 0) - low) * stretch).min(BELOW_ONE)));
            for j in 1..dim {
                let column = u.column(j);
                own.extend(rows.iter().map(|&i| column[i]));
            }
            let mut places = vec![0.0; n * dim];
            let mut p = vec![0.0; n];
            component.sample(Columns::new(&own, n), ColumnsMut::new(&mut places, n), &mut p);
            p.iter_mut().zip(&rows).for_each(|(p, &i)| *p *= density[i]);
            to_cube(component, ColumnsMut::new(&mut places, n), &mut p);
            self.add_others(k, Columns::new(&places, n), &mut p);
            for j in 0..dim {
                let (column, from) = (x.column(j), &places[j * n..(j + 1) * n]);
                rows.iter().zip(from).for_each(|(&i, x)| column[i] = *x);
            }
            rows.iter().zip(&p).for_each(|(&i, p)| pdf[i] = *p);
        }
    }

    /// The numbers of the first uniform that choose component `k`.
    fn slice(&self, k: usize) -> [f64; 2] {
        let first: u32 = self.shares[..k].iter().sum();
        [first, first + self.shares[k]].map(|part| f64::from(part) / f64::from(PARTS))
    }

    /// Multiplies `pdf` by the density of the strata at uniforms of component `k`.
    fn times_strata(&self, k: usize, u: Columns<'_>, pdf: &mut [f64]) {
        let Some(strata) = &self.strata else { return };
        let [low, high] = self.slice(k);
        let mut drawn = u.numbers().to_vec();
        drawn[..u.len()].iter_mut().for_each(|u| *u = low + *u * (high - low));
        strata.pdf(Columns::new(&drawn, u.len()), pdf);
    }

    /// From the density of component `k` at points that it drew to that of the mixture; 0 stays 0.
    fn add_others(&self, k: usize, x: Columns<'_>, pdf: &mut [f64]) {
        let weights = self.weights();
        let mut sum: Vec<f64> = pdf.iter().map(|p| weights[k] * p).collect();
        let (mut u, mut other) = (vec![0.0; x.numbers().len()], vec![0.0; x.len()]);
        for (l, component) in self.components.iter().enumerate().filter(|&(l, _)| l != k) {
            component.invert(x, ColumnsMut::new(&mut u, x.len()), &mut other);
            self.times_strata(l, Columns::new(&u, x.len()), &mut other);
            sum.iter_mut().zip(&other).for_each(|(sum, p)| *sum += weights[l] * p);
        }
        pdf.iter_mut().zip(sum).for_each(|(p, sum)| *p = if *p > 0.0 { sum } else { 0.0 });
    }

    /// The density at each point; 0 outside the cube.
    pub fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) {
        let mut u = vec![0.0; x.numbers().len()];
        let mut own = vec![0.0; x.len()];
        pdf.fill(0.0);
        for (k, (component, weight)) in self.components.iter().zip(self.weights()).enumerate() {
            component.invert(x, ColumnsMut::new(&mut u, x.len()), &mut own);
            self.times_strata(k, Columns::new(&u, x.len()), &mut own);
            pdf.iter_mut().zip(&own).for_each(|(pdf, p)| *pdf += weight * p);
        }
        for j in 0..self.dim() {
            for (pdf, x) in pdf.iter_mut().zip(x.column(j)) {
                *pdf = if (0.0..=1.0).contains(x) { *pdf } else { 0.0 };
            }
        }
    }

    /// The uniforms that `sample` maps to each point of the only component, which must lie along the coordinates.
    pub(super) fn invert_only(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) {
        self.components[0].invert(x, u.reborrow(), &mut vec![0.0; x.len()]);
        if let Some(strata) = &self.strata {
            strata.invert(u);
        }
    }
}

/// Sets the density to 0 where a turned component left the cube, and moves points there onto its face. Along the cube's
/// own axes only rounding can leave it.
fn to_cube(component: &Component, mut x: ColumnsMut<'_>, pdf: &mut [f64]) {
    let turned = component.frame().is_some();
    for j in 0..x.dim() {
        for (x, pdf) in x.column(j).iter_mut().zip(&mut *pdf) {
            if turned && !(0.0..1.0).contains(x) {
                *pdf = 0.0;
            }
            *x = x.clamp(0.0, BELOW_ONE);
        }
    }
}
