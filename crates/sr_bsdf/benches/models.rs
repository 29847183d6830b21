//! Nanoseconds of `sample`, `eval` and `pdf`, for each model seen along the normal, at 45° and at 80°.
//!
//! As the path tracer asks them: many vertices in a row, columns of numbers in and out, with the best instructions that the
//! processor has. What happens to a vertex does not depend on others, and nothing of a vertex is known beforehand, not even
//! that all look from the same angle.
//!
//! `cargo bench -p sr_bsdf --bench models`; a line for each: model, angle, function, nanoseconds. `-- blend coat` measures
//! those whose names have these in them. `benches/models.py` puts them beside Mitsuba's.

use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

use glam::{Vec2, Vec3};
use sr_bsdf::{
    AnyModel, Beckmann, Blend, Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, Eon, Ggx, Mask,
    MetallicRoughness, MetallicRoughnessInputs, Microfacet, MicrofacetKind, OrenNayar, Part, Plastic,
    Principled, PrincipledInputs, PrincipledThin, PrincipledThinInputs, Rgb, RoughCoat, RoughConductor,
    RoughDielectric, RoughPlastic, SmoothCoat, ThinDielectric,
};
use sr_sampling::isa::{Isa, Work};

/// η and k of copper at 630, 532 and 465 nm (Johnson & Christy 1972), rounded.
const COPPER: (Rgb, Rgb) = (Rgb::new(0.27, 1.09, 1.18), Rgb::new(3.41, 2.58, 2.40));

const ANGLES: [f32; 3] = [0.0, 45.0, 80.0];

/// So many that no branch is learned by heart.
const VERTICES: usize = 1024;
/// The fastest of so many passes over the vertices counts: others were disturbed.
const PASSES: usize = 200;

fn main() {
    let half = Rgb::splat(0.5);
    let ggx = Microfacet::isotropic(Ggx, 0.3);
    let beckmann = Microfacet::isotropic(Beckmann, 0.3);
    let coat = RoughCoat::new(MicrofacetKind::Ggx, 0.3, 1.5);
    let metal = PrincipledInputs { base_color: half, metallic: 1.0, roughness: 0.5, ..Default::default() };
    let all = PrincipledInputs { metallic: 0.3, spec_trans: 0.5, sheen: 0.5, clearcoat: 0.5, ..metal };
    let thin = PrincipledThinInputs { base_color: half, spec_trans: 0.5, ..Default::default() };
    let copper = RoughConductor::new(ggx, Some(COPPER), Rgb::ONE);
    let of_any: AnyModel = copper.of_any_shape().into();
    let parts = [Part::new(0.4, [], Diffuse::new(half).into()), Part::new(0.6, [], of_any)];

    // The names are those of Mitsuba's plugins.
    measure("diffuse", Diffuse::new(half));
    measure("mask", Mask::new(0.5, Diffuse::new(half)));
    measure("dielectric", Dielectric::new(1.5, Rgb::ONE, Rgb::ONE));
    measure("thindielectric", ThinDielectric::new(1.5, Rgb::ONE, Rgb::ONE));
    measure("roughdielectric, ggx", RoughDielectric::new(ggx, 1.5, Rgb::ONE, Rgb::ONE));
    measure("roughdielectric, beckmann", RoughDielectric::new(beckmann, 1.5, Rgb::ONE, Rgb::ONE));
    measure("conductor", Conductor::new(Some(COPPER), Rgb::ONE));
    measure("roughconductor, ggx", copper);
    measure("roughconductor, beckmann", RoughConductor::new(beckmann, Some(COPPER), Rgb::ONE));
    measure("plastic", Plastic::new(SmoothCoat::new(1.5), half, Rgb::ONE, false));
    measure("roughplastic, ggx", RoughPlastic::of_distribution(ggx, &coat, half, Rgb::ONE, false));
    measure("roughdiffuse", OrenNayar::new(half, 0.5));
    measure("eon", Eon::new(half, 0.5));
    measure("diffusetransmission", DiffuseTransmission::new(half, half));
    measure("principled", Principled::new(metal));
    measure("principled, all lobes", Principled::new(all));
    measure("principledthin", PrincipledThin::new(thin));
    measure("metallicroughness", MetallicRoughness::new(MetallicRoughnessInputs::default()));
    measure("blendbsdf", Blend::new(parts, false));
}

/// Prints a line for each angle and function, if the command line names no model or one like this.
fn measure(name: &str, bsdf: impl Bsdf + Copy) {
    let mut wanted = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).peekable();
    if wanted.peek().is_some() && !wanted.any(|part| name.contains(&part)) {
        return;
    }
    let mut out = std::io::stdout();
    for angle in ANGLES {
        let mut vertices = Vertices::seen_from(angle.to_radians());
        for function in [Function::Sample, Function::Eval, Function::Pdf] {
            let pass = |vertices: &mut Vertices| {
                let began = Instant::now();
                Isa::detect().run(Pass { bsdf: black_box(bsdf), function, vertices: black_box(vertices) });
                began.elapsed().as_secs_f64() * 1e9 / VERTICES as f64
            };
            let fastest = (0..PASSES).map(|_| pass(&mut vertices)).fold(f64::INFINITY, f64::min);
            let function = format!("{function:?}").to_lowercase();
            // A broken pipe is the reader's wish.
            let _ = writeln!(out, "{name}\t{angle}\t{function}\t{fastest:.2}");
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Function {
    Sample,
    Eval,
    Pdf,
}

type Column = [f32; VERTICES];

/// A column for each number that goes in or comes out.
struct Vertices {
    wo: [Column; 3],
    wi: [Column; 3],
    u_lobe: Column,
    u: [Column; 2],
    sampled: [Column; 3],
    value: [Column; 3],
    pdf: Column,
}

impl Vertices {
    /// All from an angle with the normal, lit from everywhere.
    fn seen_from(angle: f32) -> Box<Self> {
        let mut vertices = Box::new(Self {
            wo: [[angle.sin(); VERTICES], [0.0; VERTICES], [angle.cos(); VERTICES]],
            wi: [[0.0; VERTICES]; 3],
            u_lobe: [0.0; VERTICES],
            u: [[0.0; VERTICES]; 2],
            sampled: [[0.0; VERTICES]; 3],
            value: [[0.0; VERTICES]; 3],
            pdf: [0.0; VERTICES],
        });
        for i in 0..VERTICES {
            let u = Vec2::new((i as f32 + 0.5) / VERTICES as f32, (i as f32 * 0.618_034) % 1.0);
            let z = 1.0 - 2.0 * u.x;
            let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
            set(&mut vertices.wi, i, (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z));
            (vertices.u[0][i], vertices.u[1][i]) = (u.x, u.y);
            vertices.u_lobe[i] = (i as f32 * 0.754_877_7) % 1.0;
        }
        vertices
    }
}

#[inline(always)]
fn get(columns: &[Column; 3], i: usize) -> Vec3 {
    Vec3::new(columns[0][i], columns[1][i], columns[2][i])
}

#[inline(always)]
fn set(columns: &mut [Column; 3], i: usize, value: Vec3) {
    (columns[0][i], columns[1][i], columns[2][i]) = (value.x, value.y, value.z);
}

/// A function of a model, asked about all vertices.
struct Pass<'v, B> {
    bsdf: B,
    function: Function,
    vertices: &'v mut Vertices,
}

impl<B: Bsdf> Work for Pass<'_, B> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        let Self { bsdf, function, vertices: v } = self;
        match function {
            Function::Sample => {
                for i in 0..VERTICES {
                    let s = bsdf.sample(get(&v.wo, i), v.u_lobe[i], Vec2::new(v.u[0][i], v.u[1][i]));
                    let (wi, weight, pdf) =
                        s.map_or((Vec3::ZERO, Rgb::ZERO, 0.0), |s| (s.wi, s.weight, s.pdf));
                    set(&mut v.sampled, i, wi);
                    set(&mut v.value, i, weight);
                    v.pdf[i] = pdf;
                }
            }
            Function::Eval => {
                for i in 0..VERTICES {
                    set(&mut v.value, i, bsdf.eval(get(&v.wo, i), get(&v.wi, i)));
                }
            }
            Function::Pdf => {
                for i in 0..VERTICES {
                    v.pdf[i] = bsdf.pdf(get(&v.wo, i), get(&v.wi, i));
                }
            }
        }
    }
}
