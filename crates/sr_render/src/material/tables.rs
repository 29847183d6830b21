//! Tables that are the same at every point of a material: ordered while descriptions are read, each once however often it is
//! asked for, and made side by side when all are known. One takes up to a second.

use std::collections::HashMap;
use std::hash::Hash;

use rayon::prelude::*;
use sr_bsdf::{
    AlbedoTable, CoatedConductorTables, CompensatedConductor, DielectricTables, Microfacet, MicrofacetKind,
    RoughCoat,
};

/// More in one scene are an error.
pub(super) const MAX_TABLES: usize = 1000;

/// What uncommon models share.
#[derive(Clone, Debug, Default)]
pub(super) struct Tables {
    pub metals: Vec<(Microfacet, AlbedoTable)>,
    pub glasses: Vec<DielectricTables>,
    pub coated: Vec<CoatedConductorTables>,
}

/// The bits of a few numbers, which can be looked up.
type Bits<const N: usize> = [u32; N];

/// What is to be made.
#[derive(Default)]
pub(super) struct Orders {
    coats: List<(MicrofacetKind, Bits<2>, bool)>,
    metals: List<(MicrofacetKind, Bits<1>)>,
    glasses: List<(MicrofacetKind, Bits<2>)>,
    coated: List<(MicrofacetKind, Bits<3>, Option<u32>)>,
}

impl Orders {
    /// Index of the tables of a rough coating over a diffuse base.
    pub fn coat(&mut self, kind: MicrofacetKind, alpha: f32, eta: f32, is_lossless: bool) -> usize {
        self.coats.number((kind, [alpha, eta].map(f32::to_bits), is_lossless))
    }

    /// Index into [`Tables::metals`].
    pub fn metal(&mut self, kind: MicrofacetKind, alpha: f32) -> usize {
        self.metals.number((kind, [alpha.to_bits()]))
    }

    /// Index into [`Tables::glasses`].
    pub fn glass(&mut self, kind: MicrofacetKind, alpha: f32, eta: f32) -> usize {
        self.glasses.number((kind, [alpha, eta].map(f32::to_bits)))
    }

    /// Index into [`Tables::coated`].
    ///
    /// The numbers are the coat's roughness, its index, and the metal's roughness.
    pub fn coated(&mut self, kind: MicrofacetKind, numbers: [f32; 3], bounces: Option<u32>) -> usize {
        self.coated.number((kind, numbers.map(f32::to_bits), bounces))
    }

    /// How many tables are ordered.
    pub fn len(&self) -> usize {
        self.coats.keys.len() + self.metals.keys.len() + self.glasses.keys.len() + self.coated.keys.len()
    }

    /// Makes all, on rayon's current pool: those of rough coatings, and the others.
    pub fn make(self) -> (Vec<RoughCoat>, Tables) {
        let coats = self.coats.make(|(kind, [alpha, eta], is_lossless)| {
            let new = if is_lossless { RoughCoat::lossless } else { RoughCoat::new };
            new(kind, f32::from_bits(alpha), f32::from_bits(eta))
        });
        let metals = self.metals.make(|(kind, [alpha])| {
            let alpha = f32::from_bits(alpha);
            (Microfacet::isotropic(kind, alpha), CompensatedConductor::table(kind, alpha))
        });
        let glasses = self.glasses.make(|(kind, [alpha, eta])| {
            DielectricTables::new(kind, f32::from_bits(alpha), f32::from_bits(eta))
        });
        let coated = self.coated.make(|(kind, numbers, bounces)| {
            let [coat_alpha, eta, alpha] = numbers.map(f32::from_bits);
            match bounces {
                None => CoatedConductorTables::lossless(kind, coat_alpha, eta, alpha),
                Some(times) => CoatedConductorTables::walked(kind, coat_alpha, eta, alpha, times),
            }
        });
        (coats, Tables { metals, glasses, coated })
    }
}

/// Keys in the order in which they came, each once.
struct List<K> {
    numbers: HashMap<K, usize>,
    keys: Vec<K>,
}

impl<K> Default for List<K> {
    fn default() -> Self {
        Self { numbers: HashMap::new(), keys: Vec::new() }
    }
}

impl<K: Copy + Eq + Hash + Send + Sync> List<K> {
    fn number(&mut self, key: K) -> usize {
        *self.numbers.entry(key).or_insert_with(|| {
            self.keys.push(key);
            self.keys.len() - 1
        })
    }

    fn make<T: Send>(self, make: impl Fn(K) -> T + Sync + Send) -> Vec<T> {
        self.keys.into_par_iter().map(make).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_twice_is_made_once() {
        let mut orders = Orders::default();
        let kind = MicrofacetKind::Ggx;
        let asked = [0.5, 0.25, 0.5].map(|alpha| orders.coat(kind, alpha, 1.5, true));
        assert_eq!((asked, orders.coat(kind, 0.5, 1.5, false), orders.len()), ([0, 1, 0], 2, 3));
        let (coats, others) = orders.make();
        assert_eq!(coats[1], RoughCoat::lossless(kind, 0.25, 1.5));
        assert!(coats.len() == 3 && others.metals.is_empty());
    }
}
