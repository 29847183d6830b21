//! Every distribution of `sr_integrate`, with ordinary and with extreme parameters.

use std::sync::Arc;

use sr_integrate::adaptive::{Learned, Learning, learn};
use sr_integrate::distributions::{
    Affine, Alias, AreaLight, Cone, Cosine, Discrete, Disk, Exponential, FromPdf, Linear, Mixture, Normal,
    ParameterError, PiecewiseConstant, PiecewiseLinear, Power, Product, Profile, Tabulated2D, Tent, Typed,
    Uniform, UniformBox, VisibleNormals, VonMisesFisher, Zonal, spherical_rectangle, spherical_triangle,
    truncate,
};
use sr_integrate::integrate::Integrand;
use sr_integrate::{Columns, Density, Space};
use sr_sampling::Mix2;
use sr_sampling::warp::{CosineHemisphere, UniformHemisphere};

/// A density, and how exact its samples are.
#[derive(Debug)]
pub struct DensityCase {
    /// What it is, and with which parameters.
    pub name: String,
    /// It.
    pub density: Arc<dyn Density>,
    /// How far a uniform may come back from where it was, after its point was rounded.
    pub tolerance: f64,
}

/// The list under construction.
struct Cases(Vec<DensityCase>);

impl Cases {
    #[track_caller]
    fn add<D: Density + 'static>(&mut self, name: impl Into<String>, density: Result<D, ParameterError>) {
        self.share(name, density.map(|density| Arc::new(density) as Arc<dyn Density>));
    }

    #[track_caller]
    fn share(&mut self, name: impl Into<String>, density: Result<Arc<dyn Density>, ParameterError>) {
        let name = name.into();
        match density {
            Ok(density) => self.0.push(DensityCase { name, density, tolerance: 1e-9 }),
            Err(error) => panic!("{name}: {error}"),
        }
    }

    /// Of the last case.
    fn tolerance(&mut self, tolerance: f64) {
        if let Some(case) = self.0.last_mut() {
            case.tolerance = tolerance;
        }
    }
}

/// Every distribution of `sr_integrate`.
pub fn densities() -> Vec<DensityCase> {
    let mut cases = Cases(Vec::new());
    on_the_line(&mut cases);
    truncated(&mut cases);
    tables(&mut cases);
    from_functions(&mut cases);
    in_space(&mut cases);
    directions(&mut cases);
    composites(&mut cases);
    learned(&mut cases);
    cases.0
}

fn on_the_line(cases: &mut Cases) {
    cases.add("uniform", Uniform::new(0.0, 1.0));
    cases.add("uniform far from 0", Uniform::new(1e6, 1e6 + 1e-3));
    cases.tolerance(1e-6);
    cases.add("uniform, vast", Uniform::new(-1e300, 1e300));
    cases.add("linear from 0", Linear::new(0.0, 5.0, 0.0, 2.0));
    cases.add("linear, falling", Linear::new(-1.0, 1.0, 3.0, 1.0));
    cases.add("linear, to 0", Linear::new(2.0, 2.5, 1e300, 0.0));
    cases.add("tent", Tent::new(-1.0, 0.0, 1.0));
    cases.add("tent, leaning", Tent::new(-1.0, 1.8, 2.0));
    cases.add("tent, half", Tent::new(0.0, 0.0, 1.0));
    for rate in [1e-300, 0.3, 1e300] {
        cases.add(format!("exponential, rate {rate:e}"), Exponential::new(rate));
    }
    for (mean, sd) in [(0.0, 1.0), (-3.0, 1e-3), (1e3, 1e150)] {
        cases.add(format!("normal, {mean} ± {sd:e}"), Normal::new(mean, sd));
    }
    for (exponent, low, high) in [
        (2.0, 0.0, 1.0),
        (0.0, 0.0, 3.0),
        (-0.5, 0.0, 2.0),
        (-0.9, 0.0, 1.0),
        (-1.0, 0.1, 10.0),
        (-2.5, 1.0, 1e9),
        (300.0, 0.0, 1.0),
        (-300.0, 1.0, 2.0),
        (1.0, 5.0, 5.0 + 1e-6),
    ] {
        cases.add(format!("power {exponent} on [{low}, {high}]"), Power::new(exponent, low, high));
    }
    cases.tolerance(1e-6);
}

fn truncated(cases: &mut Cases) {
    let (normal, inf) = (|| Arc::new(Normal::new(0.0, 1.0).expect("a normal")), f64::INFINITY);
    for (low, high) in
        [(-1.0, 2.0), (8.0, 9.0), (-9.0, -8.0), (40.0, 41.0), (3.0, inf), (-inf, 0.5), (0.5, 0.5 + 1e-9)]
    {
        cases.share(format!("normal on [{low}, {high}]"), truncate(normal(), low, high));
    }
    cases.tolerance(1e-6);
    let exponential = Arc::new(Exponential::new(2.0).expect("an exponential"));
    cases.share("exponential on [300, 301]", truncate(exponential, 300.0, 301.0));
    let tent = Arc::new(Tent::new(-1.0, 0.0, 1.0).expect("a tent"));
    cases.share("tent on [-0.5, 0.9]", truncate(tent, -0.5, 0.9));
    let falling = Affine::new(normal(), vec![-2.0], vec![1.0]).expect("a map");
    cases.share("affine normal on [60, 70]", truncate(Arc::new(falling), 60.0, 70.0));
}

fn tables(cases: &mut Cases) {
    let edges = vec![-5.0, -4.99, 0.0, 2.0, 30.0];
    cases.add("histogram", PiecewiseConstant::new(edges.clone(), &[4.0, 1.0, 2.0, 5.0]));
    cases.add("histogram with a hole", PiecewiseConstant::new(edges, &[4.0, 0.0, 1.0, 5.0]));
    let many: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
    let counts: Vec<f64> = (0..1000).map(|i| f64::from((i * 7919) % 97)).collect();
    cases.add("histogram of a thousand bins", PiecewiseConstant::new(many.clone(), &counts));
    cases.add("polygon", PiecewiseLinear::new(vec![0.0, 1.0, 2.0, 4.0], vec![0.0, 3.0, 1.0, 2.0]));
    cases.add(
        "polygon with a hole",
        PiecewiseLinear::new(vec![0.0, 1.0, 2.0, 4.0, 5.0], vec![1.0, 0.0, 0.0, 2.0, 0.0]),
    );
    let wave: Vec<f64> = many.iter().map(|x| 1.0 + (20.0 * x).sin()).collect();
    cases.add("polygon of a thousand points", PiecewiseLinear::new(many, wave));
    for (name, weights) in [
        ("few, some 0", vec![0.0, 1.0, 0.0, 2.0, 7.0, 0.0]),
        ("wide range", (0..20).map(|i| 2.0_f64.powi(i)).collect()),
        ("many", (0..300).map(|i| f64::from(i % 17)).collect()),
    ] {
        cases.add(format!("discrete, {name}"), Discrete::new(&weights));
        cases.add(format!("alias table, {name}"), Alias::new(&weights));
    }
    let mut picture: Vec<f64> = (0..24 * 10).map(|i| f64::from(i % 11) + 0.2 * f64::from(i % 3)).collect();
    let ends = ([-1.0, 0.0], [1.0, 5.0]);
    cases.add("table over a rectangle", Tabulated2D::new(&picture, [10, 24], ends.0, ends.1));
    picture[5 * 24 + 7] = 2e4;
    picture[2 * 24..4 * 24].fill(0.0);
    cases.add("table with a peak and holes", Tabulated2D::new(&picture, [10, 24], ends.0, ends.1));
}

fn from_functions(cases: &mut Cases) {
    let pi = std::f64::consts::PI;
    cases.add("from_pdf, a sine", FromPdf::new(f64::sin, 0.0, pi, 1e-9));
    cases.add("from_pdf, a bell, coarsely", FromPdf::new(|x| (-0.5 * x * x).exp(), -8.0, 20.0, 1e-2));
    let steps = |x: f64| {
        if x < 0.1234 {
            3.0
        } else if x < 0.7 {
            0.0
        } else {
            x
        }
    };
    cases.add("from_pdf, steps with a hole", FromPdf::new(steps, 0.0, 1.0, 1e-6));
    cases.add("from_pdf, a pole at the end", FromPdf::new(|x: f64| 1.0 / x.sqrt(), 0.0, 4.0, 1e-6));
    cases.add("from_pdf, a pole inside", FromPdf::new(|x: f64| (x - 0.3).abs().powf(-0.4), 0.0, 1.0, 1e-6));
    cases.add(
        "from_pdf, a narrow peak",
        FromPdf::new(|x: f64| 1.0 / (1.0 + 1e6 * (x - 0.5).powi(2)), 0.0, 1.0, 1e-6),
    );
}

fn in_space(cases: &mut Cases) {
    cases.add("box of one dimension", UniformBox::new(&[[-1.0, 3.0]]));
    cases.add(
        "box of five dimensions",
        UniformBox::new(&[[0.0, 1.0], [-1e3, 1e3], [5.0, 6.0], [-2.0, 0.0], [0.0, 1e-9]]),
    );
    cases.add("disk", Disk::new(1.0));
    cases.add("disk, tiny", Disk::new(1e-6));
}

fn directions(cases: &mut Cases) {
    let axes = [[0.0, 0.0, 1.0], [0.0, -3.0, 0.0], [1.0, -2.0, -0.5]];
    fn about<P: Profile + 'static>(cases: &mut Cases, name: &str, profile: P, axis: [f64; 3]) {
        cases.add(format!("{name} about {axis:?}"), Zonal::new(profile, axis));
    }
    for axis in axes {
        about(cases, "uniform sphere", Cone::SPHERE, axis);
        about(cases, "uniform hemisphere", Cone::HEMISPHERE, axis);
        about(cases, "cosine hemisphere", Cosine, axis);
        for angle in [1e-4, 0.3, 2.0] {
            about(cases, &format!("cone of {angle}"), Cone::new(angle).expect("a cone"), axis);
        }
        cases.tolerance(1e-9);
        for kappa in [0.0, 1.0, 50.0, 1e6] {
            about(
                cases,
                &format!("von Mises-Fisher, {kappa}"),
                VonMisesFisher::new(kappa).expect("a lobe"),
                axis,
            );
        }
    }
    for case in &mut cases.0 {
        // Directions away from +Z are rounded by 10⁻¹⁶, narrow cones and lobes by that over their width.
        if case.name.contains("cone of 0.0001") || case.name.contains("1000000") {
            case.tolerance = 1e-8;
        }
    }
    for wo in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-3.0, 2.0, 0.1]] {
        for alpha in [[1e-4, 1e-4], [0.1, 0.5], [1.0, 1.0]] {
            cases.add(format!("visible normals of {alpha:?} from {wo:?}"), VisibleNormals::new(wo, alpha));
            cases.tolerance(1e-7);
        }
    }
    let facing = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    cases.add("area light, facing", AreaLight::new([-1.0, -1.0, 1.0], facing, [0.0; 3]));
    cases.add("area light, from behind", AreaLight::new([-1.0, -1.0, -0.5], facing, [0.1, 0.2, 0.3]));
    let leaning = [[0.6, 0.0, 0.8], [0.3, 1.0, 0.0]];
    cases.add("area light, aside", AreaLight::new([2.0, 0.5, 0.2], leaning, [0.0; 3]));
    cases.add(
        "area light, far",
        AreaLight::new([100.0, 0.0, 0.0], [[0.0, 2.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]),
    );
    cases.tolerance(1e-8);
    for (name, [a, b, c]) in [
        ("octant", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("near", [[-2.0, -1.0, 0.05], [3.0, -1.0, 0.05], [0.0, 4.0, 0.05]]),
        ("sliver", [[-3.0, 1.0, 1.0], [3.0, 1.0, 1.0], [3.0, 1.05, 1.0]]),
    ] {
        cases.add(format!("spherical triangle, {name}"), spherical_triangle(a, b, c));
        cases.tolerance(1e-3);
    }
    cases.add(
        "spherical rectangle",
        spherical_rectangle([9.0, 0.5, 0.2], [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]], [7.0, 0.0, 0.0]),
    );
    cases.tolerance(1e-3);
    let pair = Mix2::new(0.3, CosineHemisphere, UniformHemisphere).expect("weights");
    let support = vec![[-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]];
    cases.add("pair of sr_sampling", Ok(Typed::new(pair, support)));
}

fn composites(cases: &mut Cases) {
    fn arc<D: Density + 'static>(density: Result<D, ParameterError>) -> Arc<dyn Density> {
        Arc::new(density.expect("a density"))
    }
    let uniform = |low, high| arc(Uniform::new(low, high));
    cases.add(
        "product of three and two",
        Product::new(vec![
            arc(Normal::new(0.0, 1.0)),
            arc(Disk::new(2.0)),
            arc(Linear::new(0.0, 1.0, 0.0, 1.0)),
            arc(Exponential::new(1.0)),
        ]),
    );
    let parts = || vec![uniform(-3.0, -2.0), arc(Normal::new(5.0, 0.1)), arc(Exponential::new(0.1))];
    cases.add("mixture on the line", Mixture::new(parts(), vec![0.2, 0.3, 0.5]));
    cases.add("mixture of one", Mixture::new(vec![uniform(0.0, 2.0), uniform(5.0, 6.0)], vec![1.0, 0.0]));
    cases.add(
        "mixture of touching parts",
        Mixture::new(vec![uniform(0.0, 1.0), uniform(1.0, 2.0)], vec![0.1, 0.9]),
    );
    let indices = |weights: &[f64]| arc(Discrete::new(weights));
    let both = vec![indices(&[1.0, 0.0, 3.0]), indices(&[0.0, 2.0, 0.0, 0.0, 1.0])];
    cases.add("mixture of indices", Mixture::new(both, vec![0.5, 0.5]));
    let lobe = |axis, kappa| arc(Zonal::new(VonMisesFisher::new(kappa).expect("a lobe"), axis));
    let lobes = vec![lobe([1.0, 0.0, 0.0], 100.0), lobe([0.0, 0.0, -1.0], 3.0)];
    cases.add("mixture of lobes", Mixture::new(lobes, vec![0.7, 0.3]));
    let peak = |at: f64| arc(Product::new((0..4).map(|_| arc(Normal::new(at, 0.05))).collect()));
    let peaks = arc(Mixture::new(vec![peak(0.25), peak(0.75)], vec![0.5, 0.5]));
    let unit = arc(UniformBox::new(&[[0.0, 1.0]; 4]));
    cases.add("two peaks in four dimensions, and a box", Mixture::new(vec![peaks, unit], vec![0.8, 0.2]));
    cases.add("falling exponential", Affine::new(arc(Exponential::new(1.0)), vec![-2.0], vec![3.0]));
    cases.add(
        "moved histogram",
        Affine::new(arc(PiecewiseConstant::new(vec![0.0, 1.0, 3.0], &[1.0, 5.0])), vec![1e3], vec![-7.0]),
    );
    cases.add("turned disk", Affine::new(arc(Disk::new(1.0)), vec![3.0, 1.0, -1.0, 0.2], vec![5.0, 6.0]));
    let bell = arc(Product::new((0..3).map(|_| arc(Normal::new(0.0, 1.0))).collect()));
    let shear = vec![1.0, 0.0, 0.0, 0.9, 0.1, 0.0, -0.5, 2.0, 0.7];
    cases.add("correlated normal", Affine::new(bell, shear, vec![1.0, 2.0, 3.0]));
}

/// Over a box, and over directions.
fn learned(cases: &mut Cases) {
    let two_peaks = |x: Columns<'_>, f: &mut [f64]| {
        for (i, f) in f.iter_mut().enumerate() {
            let away = |at: f64| (0..x.dim()).map(|j| (x.get(i, j) - at).powi(2)).sum::<f64>();
            *f = (-100.0 * away(0.25)).exp() + (-100.0 * away(0.75)).exp();
        }
    };
    let lobe = |w: Columns<'_>, f: &mut [f64]| {
        for (i, f) in f.iter_mut().enumerate() {
            *f = (20.0 * w.get(i, 0)).exp();
        }
    };
    let box3: Arc<dyn Density> = Arc::new(UniformBox::new(&[[0.0, 1.0]; 3]).expect("a box"));
    let sphere: Arc<dyn Density> = Arc::new(Zonal::new(Cone::SPHERE, [0.0, 0.0, 1.0]).expect("a sphere"));
    let learning = Learning { seed: 1, evaluations: 20_000, rtol: 0.0, until: None };
    let cubes = [
        ("two peaks", learn(&box3, &mut Integrand::Parallel(&two_peaks), &learning, None, &mut |_| Ok(()))),
        ("a lobe", learn(&sphere, &mut Integrand::Parallel(&lobe), &learning, None, &mut |_| Ok(()))),
    ];
    for ((name, lesson), base) in cubes.into_iter().zip([box3, sphere]) {
        let lesson = lesson.expect("integrands of this file do not fail");
        cases.add(format!("learned from {name}"), Ok(Learned::new(base, lesson.cube)));
    }
}

impl DensityCase {
    /// Can points be told from one another along every axis? Indices cannot, by any density.
    pub fn is_continuous(&self) -> bool {
        self.density.space() != Space::Counting
    }
}
