//! Hair of all kinds.

use sr_bsdf::{AnyBsdf, Hair, HairInputs, Rgb};

/// All models, named.
pub(crate) fn models() -> Vec<(String, AnyBsdf<'static>)> {
    let brown = HairInputs::default();
    let fur = HairInputs { sigma_a: Rgb::new(0.1, 0.2, 0.4), beta_m: 0.25, beta_n: 0.9, ..brown };
    let inputs = [
        ("brown", brown),
        ("smooth", HairInputs { beta_m: 0.12, beta_n: 0.15, ..brown }),
        ("rough", HairInputs { beta_m: 1.0, beta_n: 1.0, ..brown }),
        ("fur", fur),
        ("black", HairInputs { sigma_a: Rgb::splat(50.0), ..brown }),
        ("with tilted scales", HairInputs { alpha: 0.3, eta: 1.3, ..fur }),
        ("in glass", HairInputs { eta: 0.9, ..fur }),
    ];
    inputs.map(|(name, inputs)| (format!("hair {name}"), Hair::new(inputs).into())).into()
}

/// Those that absorb nothing.
pub(crate) fn white_models() -> Vec<(String, AnyBsdf<'static>)> {
    let white = HairInputs { sigma_a: Rgb::ZERO, ..HairInputs::default() };
    let inputs = [
        ("white hair", white),
        ("white hair, smooth", HairInputs { beta_m: 0.1, beta_n: 0.1, ..white }),
        ("white hair, rough and tilted", HairInputs { beta_m: 0.8, beta_n: 1.0, alpha: 0.2, ..white }),
    ];
    inputs.map(|(name, inputs)| (name.to_owned(), Hair::new(inputs).into())).into()
}
