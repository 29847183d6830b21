//! What every sequence promises: independence across dimensions, pixels, seeds and replicates, and
//! the rate at which it converges.
//!
//! Failure rate: every statistic below is a sum of many terms, compared with 5.5 standard deviations
//! (4·10⁻⁸ two-sided); with fewer than 1000 comparisons, 4·10⁻⁵ for the file. The seeds are fixed.

use sr_sampling::{Independent, OwenSobol, SampleId, Sequence};

const LIMIT: f64 = 5.5;

/// A named way of getting the i-th number of a stream.
type Stream<'a> = (String, Box<dyn Fn(u32) -> f64 + 'a>);

/// Streams that have to be independent of one another: other dimension, index, pixel, replicate, seed.
fn streams<'a, Q: Sequence + 'a>(new: impl Fn(u64) -> Q, root: &'a Q, index: u32) -> Vec<Stream<'a>> {
    // A stream runs over pixels: for a randomised sequence, those are the independent trials.
    let at = move |pixel| SampleId { pixel, index };
    let mut list: Vec<Stream> =
        vec![("pixel + 1".into(), Box::new(move |i| root.get_1d(at(i + 1), 0).into()))];
    for dim in [0, 1, 2, 3, 64, 1000] {
        list.push((format!("dim {dim}"), Box::new(move |i| root.get_1d(at(i), dim).into())));
    }
    list.push(("pair, y".into(), Box::new(move |i| root.get_2d(at(i), 6).y.into())));
    for number in 0..4 {
        let replicate = root.replicate(number);
        list.push((format!("replicate {number}"), Box::new(move |i| replicate.get_1d(at(i), 0).into())));
    }
    let nested = root.replicate(0).replicate(1);
    list.push(("replicate 0, 1".into(), Box::new(move |i| nested.get_1d(at(i), 0).into())));
    for seed in [1, 2] {
        let other = new(seed);
        list.push((format!("seed {seed}"), Box::new(move |i| other.get_1d(at(i), 0).into())));
    }
    list
}

/// Chi-square over a 16 × 16 grid of two streams, as a number of standard deviations from its mean.
fn joint_z(a: &dyn Fn(u32) -> f64, b: &dyn Fn(u32) -> f64) -> f64 {
    const N: u32 = 1 << 15;
    let mut cells = [0_u32; 256];
    for i in 0..N {
        cells[(a(i) * 16.0) as usize * 16 + (b(i) * 16.0) as usize] += 1;
    }
    let expected = f64::from(N) / 256.0;
    let chi2: f64 = cells.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
    // Wilson & Hilferty (1931): the cube root of chi-square over its degrees of freedom is nearly normal.
    let spread = 2.0 / (9.0 * 255.0);
    ((chi2 / 255.0).cbrt() - (1.0 - spread)) / spread.sqrt()
}

fn check_independence<Q: Sequence>(new: impl Fn(u64) -> Q) {
    let root = new(0);
    for index in [0, 1, 1023] {
        let list = streams(&new, &root, index);
        assert!(list.len() >= 14);
        for (i, (name_a, a)) in list.iter().enumerate() {
            for (name_b, b) in &list[i + 1..] {
                let z = joint_z(a, b);
                assert!(z < LIMIT, "{name_a} and {name_b} at index {index}: {z} standard deviations");
            }
        }
    }
}

#[test]
fn independent_streams_are_independent() {
    check_independence(Independent::new);
}

#[test]
fn sobol_streams_are_independent() {
    check_independence(OwenSobol::new);
}

/// Within a pixel, different indices of `Independent` are unrelated too.
#[test]
fn independent_indices_are_independent() {
    let sequence = Independent::new(4);
    let at = |index| SampleId { pixel: 5, index };
    let this = |i| f64::from(sequence.get_1d(at(i), 0));
    for step in [1, 2, 16, 1024] {
        let z = joint_z(&this, &|i| f64::from(sequence.get_1d(at(i + step), 0)));
        assert!(z < LIMIT, "step {step}: {z}");
        let z = joint_z(&this, &|i| f64::from(sequence.get_1d(at(i), step)));
        assert!(z < LIMIT, "dimension {step}: {z}");
    }
}

/// Padded dimensions of one pixel: as a pair they are a random pairing, not a net and not a line.
#[test]
fn sobol_dimensions_of_one_pixel_are_randomly_paired() {
    let sequence = OwenSobol::new(4);
    let mut worst = 0.0_f64;
    for pixel in 0..20 {
        for other in [2, 4, 10, 101] {
            let get = |i: u32, dim| f64::from(sequence.get_1d(SampleId { pixel, index: i }, dim)) - 0.5;
            const N: u32 = 4096;
            let covariance: f64 = (0..N).map(|i| get(i, 0) * get(i, other)).sum::<f64>() / f64::from(N);
            worst = worst.max(covariance.abs() * 12.0 * f64::from(N).sqrt());
        }
    }
    assert!(worst < LIMIT, "{worst} standard deviations");
}

/// The standard deviation of an estimate of ∫ f over [0, 1)², by replicates.
fn spread<Q: Sequence>(root: &Q, n: u32, f: impl Fn(f64, f64) -> f64) -> f64 {
    const REPLICATES: u32 = 64;
    let mut sum_of_squares = 0.0;
    for number in 0..REPLICATES {
        let sequence = root.replicate(number);
        let mean: f64 = (0..n)
            .map(|index| {
                let u = sequence.get_2d(SampleId { pixel: 0, index }, 0);
                f(f64::from(u.x), f64::from(u.y))
            })
            .sum::<f64>()
            / f64::from(n);
        sum_of_squares += mean * mean;
    }
    (sum_of_squares / f64::from(REPLICATES)).sqrt()
}

/// f(x, y) = x·y − ¼ is smooth: the error of scrambled nets falls like n^(−3/2) up to a logarithm
/// (Owen 1997), that of independent points like n^(−1/2). Between 2⁶ and 2¹² points that is a factor
/// of 512 and of 8; each spread is known within 9 %.
#[test]
fn smooth_integrands_converge_at_the_known_rate() {
    let f = |x: f64, y: f64| x * y - 0.25;
    let gain = |few: f64, many: f64| few / many;
    let independent = Independent::new(8);
    let gain_independent = gain(spread(&independent, 1 << 6, f), spread(&independent, 1 << 12, f));
    assert!((5.0..12.0).contains(&gain_independent), "{gain_independent}");
    let sobol = OwenSobol::new(8);
    let gain_sobol = gain(spread(&sobol, 1 << 6, f), spread(&sobol, 1 << 12, f));
    assert!((200.0..900.0).contains(&gain_sobol), "{gain_sobol}");
}

/// Whatever the number of points, the mean over replicates is right.
#[test]
fn both_are_unbiased_for_any_number_of_points() {
    fn check<Q: Sequence>(root: &Q) {
        for n in [1, 3, 7, 100] {
            const REPLICATES: u32 = 4096;
            let (mut sum, mut squares) = (0.0, 0.0);
            for number in 0..REPLICATES {
                let sequence = root.replicate(number);
                let mean = (0..n)
                    .map(|index| {
                        let u = sequence.get_2d(SampleId { pixel: 1, index }, 5);
                        f64::from(u.x * u.x + u.y) - 5.0 / 6.0
                    })
                    .sum::<f64>()
                    / f64::from(n);
                sum += mean;
                squares += mean * mean;
            }
            let z = sum / squares.sqrt();
            assert!(z.abs() < LIMIT, "n = {n}: {z} standard errors");
        }
    }
    check(&Independent::new(2));
    check(&OwenSobol::new(2));
}

#[test]
fn pure_and_in_range() {
    fn check<Q: Sequence>(root: &Q) {
        for i in (0..=u32::MAX).step_by(1 << 16).chain([u32::MAX]) {
            let at = SampleId { pixel: i, index: i.rotate_left(16) };
            let u = root.get_2d(at, i);
            assert_eq!(u, root.clone().get_2d(at, i));
            for x in [u.x, u.y, root.get_1d(at, i)] {
                assert!((0.0..1.0).contains(&x), "{x}");
            }
        }
    }
    check(&Independent::new(u64::MAX));
    check(&OwenSobol::new(u64::MAX));
}
