//! Lights and glasses that have names.

/// A light's name in pbrt, and the chromaticity of the CIE's illuminant (CIE 015:2018, for the 2° observer).
const ILLUMINANTS: &[(&str, [f64; 2])] = &[
    ("stdillum-A", [0.44758, 0.40745]),
    ("stdillum-D50", [0.34567, 0.35851]),
    ("stdillum-D65", [0.31272, 0.32903]),
    ("stdillum-F1", [0.31310, 0.33727]),
    ("stdillum-F2", [0.37208, 0.37529]),
    ("stdillum-F3", [0.40910, 0.39430]),
    ("stdillum-F4", [0.44018, 0.40329]),
    ("stdillum-F5", [0.31379, 0.34531]),
    ("stdillum-F6", [0.37790, 0.38835]),
    ("stdillum-F7", [0.31292, 0.32933]),
    ("stdillum-F8", [0.34588, 0.35875]),
    ("stdillum-F9", [0.37417, 0.37281]),
    ("stdillum-F10", [0.34609, 0.35986]),
    ("stdillum-F11", [0.38052, 0.37713]),
    ("stdillum-F12", [0.43695, 0.40441]),
    // SMPTE ST 2065-1.
    ("illum-acesD60", [0.32168, 0.33767]),
];

/// A glass's name in pbrt, and its index of refraction at 587.6 nm, from its maker's data sheet.
pub const GLASSES: &[(&str, f64)] = &[
    ("glass-BK7", 1.51680),
    ("glass-BAF10", 1.67003),
    ("glass-FK51A", 1.48656),
    ("glass-LASF9", 1.85025),
    // pbrt's names of SF5, SF10 and SF11.
    ("glass-F5", 1.67270),
    ("glass-SF5", 1.67270),
    ("glass-F10", 1.72825),
    ("glass-SF10", 1.72825),
    ("glass-F11", 1.78472),
    ("glass-SF11", 1.78472),
];

/// The chromaticity x, y of a light.
pub fn illuminant(name: &str) -> Option<[f64; 2]> {
    ILLUMINANTS.iter().find(|(known, _)| *known == name).map(|&(_, xy)| xy)
}

/// The index of refraction of a glass.
pub fn glass(name: &str) -> Option<f64> {
    GLASSES.iter().find(|(known, _)| *known == name).map(|&(_, index)| index)
}
