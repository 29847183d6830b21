//! Models that give back what one bounce between facets or layers loses.

use std::sync::LazyLock;

use sr_bsdf::{
    AlbedoTable, AnyBsdf, CoatedConductor, CoatedConductorTables, CompensatedConductor,
    CompensatedDielectric, DielectricTables, Microfacet, MicrofacetKind, Rgb, RoughCoat, RoughPlastic,
};

use crate::bsdfs::{COPPER, GREEN, PINK};

const KINDS: [MicrofacetKind; 3] =
    [MicrofacetKind::Beckmann, MicrofacetKind::Ggx, MicrofacetKind::GgxCorrelated];
const ALPHAS: [f32; 3] = [0.1, 0.5, 1.0];

struct Tables {
    kind: MicrofacetKind,
    alpha: f32,
    metal: AlbedoTable,
    glass: DielectricTables,
    /// A smooth coat, and a rough one.
    coated: [CoatedConductorTables; 2],
    /// Rough layers that lose light.
    walked: CoatedConductorTables,
    plastic: RoughCoat,
}

static TABLES: LazyLock<Vec<Tables>> = LazyLock::new(|| {
    let tables = |kind, alpha| Tables {
        kind,
        alpha,
        metal: CompensatedConductor::table(kind, alpha),
        glass: DielectricTables::new(kind, alpha, 1.5),
        coated: [0.0, 0.3].map(|coat| CoatedConductorTables::lossless(kind, coat, 1.5, alpha)),
        walked: CoatedConductorTables::walked(kind, 0.3, 1.5, alpha, 5),
        plastic: RoughCoat::lossless(kind, alpha, 1.5),
    };
    KINDS.into_iter().flat_map(|kind| ALPHAS.map(|alpha| tables(kind, alpha))).collect()
});

/// Coloured ones.
pub(crate) fn models() -> Vec<(String, AnyBsdf<'static>)> {
    let walked = TABLES.iter().map(|t| {
        let model = CoatedConductor::new(&t.walked, Some(COPPER), PINK);
        (format!("lossy coated conductor {:?} {}", t.kind, t.alpha), model.into())
    });
    walked.chain(named("", Some(COPPER), [GREEN, PINK])).collect()
}

/// Lossless ones: a furnace has to be white. The names begin with "white".
pub(crate) fn white_models() -> Vec<(String, AnyBsdf<'static>)> {
    named("white ", None, [Rgb::ONE; 2])
}

fn named(
    prefix: &str,
    metal: Option<(Rgb, Rgb)>,
    [color, other]: [Rgb; 2],
) -> Vec<(String, AnyBsdf<'static>)> {
    let mut models: Vec<(String, AnyBsdf<'static>)> = Vec::new();
    for t in TABLES.iter() {
        let name = format!("{:?} {}", t.kind, t.alpha);
        let distribution = Microfacet::isotropic(t.kind, t.alpha);
        let conductor = CompensatedConductor::new(distribution, &t.metal, metal, other);
        models.push((format!("{prefix}compensated conductor {name}"), conductor.into()));
        let glass = CompensatedDielectric::new(&t.glass, color, other);
        models.push((format!("{prefix}compensated dielectric {name}"), glass.into()));
        let plastic = RoughPlastic::new(&t.plastic, color, other, true);
        models.push((format!("{prefix}compensated plastic {name}"), plastic.into()));
        for (coat, tables) in ["smooth", "rough"].iter().zip(&t.coated) {
            let coated = CoatedConductor::new(tables, metal, other);
            models.push((format!("{prefix}{coat}ly coated conductor {name}"), coated.into()));
        }
    }
    models
}
