//! Every distribution of `sr_sampling`, with the test that fits its measure.

use glam::{Vec2, Vec3};
use sr_sampling::warp::{
    AnyHemisphere, CosineHemisphere, RegularPolygon, SphericalRectangle, SphericalTriangle, UniformCone,
    UniformDisk, UniformHemisphere, UniformRectangle, UniformSphere, UniformTriangle,
};
use sr_sampling::{
    AliasTable, Discrete, Distribution, Independent, Invert, Mix2, Mixture, PiecewiseConstant1D,
    PiecewiseConstant2D, Plane, Sample, SampleId, Sequence, SummedArea,
};
use sr_stats::{Chi2Settings, TestReport, chi2};

use crate::lobe::Lobe;

/// A distribution behind what can be asked of it.
pub struct DistributionCase {
    /// What it is, and with which parameters.
    pub name: String,
    chi2: Box<dyn Fn(Chi2Settings) -> TestReport + Send + Sync>,
    round_trip: Option<Box<dyn Fn(u64) -> RoundTrip + Send + Sync>>,
}

/// How well `invert` undoes `sample`.
#[derive(Clone, Copy, Debug)]
pub struct RoundTrip {
    /// The number of uniforms tried.
    pub tried: usize,
    /// How many came back farther than the tolerance from where they were.
    pub missed: usize,
    /// The worst distance.
    pub worst: f32,
}

impl DistributionCase {
    /// Does what is drawn follow the density?
    pub fn chi2(&self, settings: Chi2Settings) -> TestReport {
        (self.chi2)(settings)
    }

    /// Is `invert(sample(u)) = u`? `None` if the distribution cannot be inverted.
    pub fn round_trip(&self, seed: u64) -> Option<RoundTrip> {
        self.round_trip.as_ref().map(|check| check(seed))
    }
}

/// Uniforms that can be drawn and compared.
trait Compare: Copy {
    fn draw(sequence: &Independent, index: u32) -> Self;
    fn distance(self, other: Self) -> f32;
}

impl Compare for f32 {
    fn draw(sequence: &Independent, index: u32) -> Self {
        sequence.get_1d(SampleId { pixel: 0, index }, 0)
    }
    fn distance(self, other: Self) -> f32 {
        (self - other).abs()
    }
}

impl Compare for Vec2 {
    fn draw(sequence: &Independent, index: u32) -> Self {
        sequence.get_2d(SampleId { pixel: 0, index }, 0)
    }
    fn distance(self, other: Self) -> f32 {
        Vec2::distance(self, other)
    }
}

fn round_trip<D: Invert<Uniform: Compare>>(distribution: &D, tolerance: f32, seed: u64) -> RoundTrip {
    let sequence = Independent::new(seed);
    let mut result = RoundTrip { tried: 0, missed: 0, worst: 0.0 };
    for index in 0..10_000 {
        let u = D::Uniform::draw(&sequence, index);
        let Some(sample) = distribution.sample(u) else { continue };
        let error = distribution.invert(sample.value).map_or(f32::INFINITY, |back| back.distance(u));
        result.tried += 1;
        result.worst = result.worst.max(error);
        result.missed += usize::from(error.is_nan() || error > tolerance);
    }
    result
}

/// The list under construction.
struct Cases(Vec<DistributionCase>);

impl Cases {
    fn add<D, T>(&mut self, name: &str, distribution: D, test: T)
    where
        D: Distribution + Send + Sync + 'static,
        T: Fn(&D, Chi2Settings) -> TestReport + Send + Sync + 'static,
    {
        let chi2 = Box::new(move |settings| test(&distribution, settings));
        self.0.push(DistributionCase { name: name.into(), chi2, round_trip: None });
    }

    /// `tolerance`: how far a uniform may come back from where it was, after its point was rounded.
    fn add_invertible<D, T>(&mut self, name: &str, distribution: D, tolerance: f32, test: T)
    where
        D: Invert<Uniform: Compare> + Clone + Send + Sync + 'static,
        T: Fn(&D, Chi2Settings) -> TestReport + Send + Sync + 'static,
    {
        self.add(name, distribution.clone(), test);
        let check = move |seed| round_trip(&distribution, tolerance, seed);
        self.0.last_mut().expect("just added").round_trip = Some(Box::new(check));
    }
}

/// Every distribution of `sr_sampling`, with ordinary and with extreme parameters.
pub fn distribution_cases() -> Vec<DistributionCase> {
    let mut cases = Cases(Vec::new());
    directions(&mut cases);
    surfaces(&mut cases);
    tables(&mut cases);
    windows(&mut cases);
    mixtures(&mut cases);
    cases.0
}

fn directions(cases: &mut Cases) {
    cases.add_invertible("uniform hemisphere", UniformHemisphere, 1e-5, chi2::sphere);
    cases.add_invertible("cosine hemisphere", CosineHemisphere, 1e-5, chi2::sphere);
    cases.add_invertible("uniform sphere", UniformSphere, 1e-5, chi2::sphere);
    for sin2 in [1e-10_f32, 1e-6, 1e-3, 0.5, 1.0] {
        let cone = UniformCone::from_sin2(sin2).expect("a cone");
        cases.add_invertible(&format!("cone, sin² = {sin2}"), cone, 1e-5, chi2::sphere);
    }
    let wide = UniformCone::from_cos(-0.3).expect("a cone");
    cases.add_invertible("cone wider than a hemisphere", wide, 1e-5, chi2::sphere);

    let at = Vec3::new(0.1, -0.2, 0.3);
    for (name, vertices) in [
        ("octant", [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p + at)),
        ("clockwise", [Vec3::X, Vec3::Z, Vec3::Y].map(|p| p + at)),
        ("near", [Vec3::new(-2.0, -1.0, 0.35), Vec3::new(3.0, -1.0, 0.35), Vec3::new(0.0, 4.0, 0.35)]),
        ("far", [Vec3::new(5.0, 5.0, 5.0), Vec3::new(5.5, 5.0, 5.0), Vec3::new(5.0, 5.4, 5.1)]),
        ("sliver", [Vec3::new(-3.0, 1.0, 1.0), Vec3::new(3.0, 1.0, 1.0), Vec3::new(3.0, 1.05, 1.0)]),
    ] {
        let triangle = SphericalTriangle::new(vertices, at).expect("a triangle");
        cases.add_invertible(&format!("spherical triangle, {name}"), triangle, 1e-3, chi2::sphere);
    }
    for (name, corner, edges) in [
        ("facing", Vec3::new(-1.0, -1.0, 1.0), [2.0 * Vec3::X, 2.0 * Vec3::Y]),
        ("behind", Vec3::new(-1.0, -1.0, -0.5), [2.0 * Vec3::Y, 2.0 * Vec3::X]),
        ("aside", Vec3::new(2.0, 0.5, 0.2), [Vec3::new(0.6, 0.0, 0.8), Vec3::Y]),
        ("grazing", Vec3::new(0.5, -1.0, 0.31), [2.0 * Vec3::X, 2.0 * Vec3::Y]),
        ("far", Vec3::new(0.0, 0.0, 20.0), [2.0 * Vec3::X, 0.5 * Vec3::Y]),
    ] {
        let rectangle = SphericalRectangle::new(corner, edges, at).expect("a rectangle");
        cases.add_invertible(&format!("spherical rectangle, {name}"), rectangle, 1e-3, chi2::sphere);
    }
    // Not a distribution of `sr_sampling`: these are here so that the test is tried on narrow peaks.
    for alpha in [0.5, 0.05, 0.01, 0.001] {
        for (place, axis) in [("pole", Vec3::Z), ("horizon", Vec3::X), ("between", Vec3::new(0.5, -0.6, 0.4))]
        {
            let lobe = Lobe::new(axis, alpha);
            cases.add(&format!("lobe of width {alpha} at the {place}"), lobe, chi2::sphere);
        }
    }
}

fn surfaces(cases: &mut Cases) {
    let square = [Vec2::splat(-1.0), Vec2::splat(1.0)];
    cases.add_invertible("disk", UniformDisk, 1e-5, move |d, settings| chi2::plane(d, square, settings));
    for (sides, rotation) in [(3, 0.1), (6, 0.0), (9, -2.0)] {
        let polygon = RegularPolygon::new(sides, rotation).expect("a polygon");
        let over_square = move |d: &RegularPolygon, settings| chi2::plane(d, square, settings);
        cases.add_invertible(&format!("polygon of {sides} sides"), polygon, 1e-4, over_square);
    }
    let corner = Vec3::new(3.0, -1.0, 2.0);
    let edges = [Vec3::new(1.0, 0.5, 0.0), Vec3::new(-0.3, 0.2, 2.0)];
    let triangle = UniformTriangle::new([corner, corner + edges[0], corner + edges[1]]).expect("a triangle");
    let over_edges = move |d: &UniformTriangle, settings| chi2::area(d, corner, edges, settings);
    cases.add_invertible("triangle", triangle, 1e-4, over_edges);
    let rectangle = UniformRectangle::new(corner, edges).expect("a rectangle");
    let over_edges = move |d: &UniformRectangle, settings| chi2::area(d, corner, edges, settings);
    cases.add_invertible("rectangle", rectangle, 1e-4, over_edges);
}

fn tables(cases: &mut Cases) {
    let weights: [(&str, Vec<f32>); 4] = [
        ("one", vec![3.0]),
        ("few, some 0", vec![0.0, 1.0, 0.0, 2.0, 7.0, 0.0]),
        ("wide range", (0..20).map(|i| 2.0_f32.powi(i)).collect()),
        ("many", (0..300).map(|i| (i % 17) as f32).collect()),
    ];
    for (name, weights) in weights {
        let len = weights.len();
        let density = PiecewiseConstant1D::from_values(&weights).expect("a table");
        let over_unit = |d: &PiecewiseConstant1D, settings| chi2::line(d, [0.0, 1.0], settings);
        cases.add_invertible(&format!("piecewise constant 1D, {name}"), density, 1e-5, over_unit);
        if len > 1 {
            let over_indices = move |d: &Discrete, settings| chi2::counting(d, len, settings);
            cases.add(&format!("discrete, {name}"), Discrete::new(&weights).expect("a table"), over_indices);
            let over_indices = move |d: &AliasTable, settings| chi2::counting(d, len, settings);
            cases.add(
                &format!("alias table, {name}"),
                AliasTable::new(&weights).expect("a table"),
                over_indices,
            );
        }
    }
    let (edges, counts) = ([-5.0, -4.99, 0.0, 2.0, 30.0], [4.0, 1.0, 0.0, 5.0]);
    let uneven = PiecewiseConstant1D::from_counts(&edges, &counts).expect("a table");
    let over_range = |d: &PiecewiseConstant1D, settings| chi2::line(d, [-5.0, 30.0], settings);
    cases.add_invertible("piecewise constant 1D, uneven bins", uneven, 1e-3, over_range);

    let unit = [Vec2::ZERO, Vec2::ONE];
    let picture: Vec<f32> = (0..24 * 10).map(|i| (i % 11) as f32 + 0.2 * (i % 3) as f32).collect();
    let mut sunny = picture.clone();
    sunny[5 * 24 + 7] = 2e4;
    sunny[2 * 24..4 * 24].fill(0.0);
    for (name, values, tolerance) in [("mild", picture, 1e-4), ("one bright pixel", sunny, 1e-2)] {
        let density = PiecewiseConstant2D::new(&values, 24).expect("a table");
        let over_unit = move |d: &PiecewiseConstant2D, settings| chi2::plane(d, unit, settings);
        cases.add_invertible(&format!("piecewise constant 2D, {name}"), density, tolerance, over_unit);
    }
}

/// A window together with its table.
struct WindowOf {
    table: SummedArea,
    low: Vec2,
    high: Vec2,
}

impl Distribution for WindowOf {
    type Measure = Plane;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        self.table.window(self.low, self.high)?.sample(u)
    }

    fn pdf(&self, p: Vec2) -> f32 {
        self.table.window(self.low, self.high).map_or(0.0, |window| window.pdf(p))
    }
}

fn windows(cases: &mut Cases) {
    let mut values: Vec<f32> = (0..24 * 10).map(|i| (i % 11) as f32 + 0.2 * (i % 3) as f32).collect();
    values[5 * 24 + 7] = 3e3;
    values[2 * 24..4 * 24].fill(0.0);
    for (name, low, high) in [
        ("all", Vec2::ZERO, Vec2::ONE),
        ("with the bright cell", Vec2::new(0.13, 0.21), Vec2::new(0.5, 0.77)),
        ("within a cell", Vec2::new(0.51, 0.61), Vec2::new(0.53, 0.69)),
        ("thin", Vec2::new(0.02, 0.05), Vec2::new(0.97, 0.051)),
    ] {
        let table = SummedArea::new(&values, 24).expect("a table");
        let over_window = move |d: &WindowOf, settings| chi2::plane(d, [low, high], settings);
        cases.add(&format!("window, {name}"), WindowOf { table, low, high }, over_window);
    }
}

fn mixtures(cases: &mut Cases) {
    let cone = UniformCone::from_sin2(0.01).expect("a cone");
    cases.add("mixture of a pair", Mix2::new(0.3, CosineHemisphere, cone).expect("weights"), chi2::sphere);
    let nested = Mix2::new(0.5, CosineHemisphere, cone).expect("weights");
    cases.add(
        "mixture of a pair in a pair",
        Mix2::new(0.25, UniformSphere, nested).expect("weights"),
        chi2::sphere,
    );
    let parts = [
        (0.2, AnyHemisphere::Cosine(CosineHemisphere)),
        (0.0, AnyHemisphere::Uniform(UniformHemisphere)),
        (0.8, AnyHemisphere::Uniform(UniformHemisphere)),
    ];
    cases.add("mixture of a list", Mixture::new(parts).expect("weights"), chi2::sphere);
    let third = [0.5, -0.1, -0.8].map(|cos| (1.0 / 3.0, UniformCone::from_cos(cos).expect("a cone")));
    cases.add("mixture of cones", Mixture::new(third).expect("weights"), chi2::sphere);
}
