//! Weights of multiple importance sampling: at every sample they sum to 1 over the techniques that can draw it.

use sr_sampling::{Heuristic, Independent, SampleId, Sequence};

use crate::subject::{Group, Subject, Verdict};

pub fn subjects() -> Vec<Subject> {
    let each = |(name, heuristic)| {
        Subject::new(Group::Weights, name).check("sum to 1", move |seed| weights_sum_to_one(heuristic, seed))
    };
    [
        ("balance", Heuristic::Balance),
        ("power", Heuristic::Power),
        ("cutoff", Heuristic::Cutoff),
        ("maximum", Heuristic::Maximum),
    ]
    .map(each)
    .into()
}

/// Up to five techniques, with densities over many orders of magnitude, some of them 0, tied or infinite.
fn weights_sum_to_one(heuristic: Heuristic, seed: u64) -> Verdict {
    let sequence = Independent::new(seed);
    Verdict::of((0..20_000).find_map(|index| {
        let u = |dim| sequence.get_1d(SampleId { pixel: 0, index }, dim);
        let techniques = 1 + (u(0) * 5.0) as usize;
        let density = |k: usize| match (10.0 * u(2 * k as u32 + 1)) as u32 {
            0 => 0.0,
            1 => 1.0,
            _ => 10.0_f64.powf(f64::from(u(2 * k as u32 + 2)) * 600.0 - 300.0),
        };
        let all: Vec<f64> = (0..techniques).map(density).collect();
        let weights: Vec<f64> = all.iter().map(|&p| heuristic.weight(p, &all)).collect();
        let sum: f64 = weights.iter().sum();
        let expected = f64::from(u8::from(all.iter().any(|&p| p > 0.0)));
        let outside = weights.iter().any(|w| !(0.0..=1.0).contains(w));
        let off = outside || !((sum - expected).abs() < 1e-12);
        off.then(|| format!("densities {all:?} get weights {weights:?}, which sum to {sum}"))
    }))
}
