//! Shares of [0, 1): which of many entries a uniform selects.

use super::parameter::{ParameterError, checked_sum};

/// Cumulative probabilities of a list of weights, and a guide into them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bins {
    /// n + 1 numbers from 0 to 1.
    cumulative: Vec<f64>,
    /// For each of some equal parts of [0, 1), the entry that its lower end selects: the cutpoint method
    /// (Chen & Asau 1974), so that a search takes two steps on average, whatever the weights.
    guide: Vec<u32>,
}

/// What a uniform selects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Picked {
    /// The entry, never one of weight 0.
    pub index: usize,
    /// Where in the entry's share the uniform lies: a uniform again.
    pub rest: f64,
}

/// The most entries.
const MAX_LEN: usize = u32::MAX as usize - 1;

impl Bins {
    /// An entry for each weight; and the sum of the weights. `argument` is what the weights are called.
    pub fn new(argument: &'static str, weights: &[f64]) -> Result<(Self, f64), ParameterError> {
        let sum = checked_sum(argument, weights)?;
        if weights.len() > MAX_LEN {
            return Err(ParameterError::Length {
                argument,
                len: weights.len(),
                need: format!("at most {MAX_LEN}"),
            });
        }
        let mut cumulative = Vec::with_capacity(weights.len() + 1);
        cumulative.push(0.0);
        let mut below = 0.0;
        let last_positive = weights.iter().rposition(|&w| w > 0.0).unwrap_or(0);
        for (i, weight) in weights.iter().enumerate() {
            below += weight;
            cumulative.push(if i >= last_positive { 1.0 } else { (below / sum).min(1.0) });
        }
        let parts = weights.len().next_power_of_two();
        let mut index = 0;
        let guide = (0..parts)
            .map(|part| {
                let low = part as f64 / parts as f64;
                while cumulative[index + 1] <= low {
                    index += 1;
                }
                index as u32
            })
            .collect();
        Ok((Self { cumulative, guide }, sum))
    }

    /// The number of entries.
    pub fn len(&self) -> usize {
        self.cumulative.len() - 1
    }

    /// The entry whose share of [0, 1) holds `u`.
    #[inline]
    pub fn pick(&self, u: f64) -> Picked {
        let u = u.clamp(0.0, 1.0 - 0.5 * f64::EPSILON);
        let mut index = self.guide[(u * self.guide.len() as f64) as usize] as usize;
        while self.cumulative[index + 1] <= u {
            index += 1;
        }
        let low = self.cumulative[index];
        Picked { index, rest: (u - low) / (self.cumulative[index + 1] - low) }
    }

    /// The least entry up to which the probabilities sum to `u` or more, never one of probability 0.
    pub fn least(&self, u: f64) -> usize {
        let reached = self.cumulative.partition_point(|&c| c < u).max(1) - 1;
        // From an entry of probability 0 on to the next that has some.
        self.cumulative[reached + 1..]
            .iter()
            .position(|&c| c > self.cumulative[reached])
            .map_or(reached, |k| reached + k)
    }

    /// The share of all entries before this one.
    #[inline]
    pub fn below(&self, index: usize) -> f64 {
        self.cumulative[index]
    }

    /// The uniform that picks an entry and leaves `rest`.
    #[inline]
    pub fn unpick(&self, index: usize, rest: f64) -> f64 {
        let low = self.cumulative[index];
        low + rest * (self.cumulative[index + 1] - low)
    }
}

/// The interval between two edges that holds `x`: from its lower edge up to, but without, its upper; the last
/// one with both. `None` outside, and for NaN.
#[inline]
pub(crate) fn locate(edges: &[f64], x: f64) -> Option<usize> {
    let last = edges.len() - 1;
    if x >= edges[0] && x < edges[last] {
        Some(edges.partition_point(|&edge| edge <= x) - 1)
    } else {
        (x == edges[last]).then(|| last - 1)
    }
}

/// The number at `t` in [0, 1] of the way through an interval, kept within it.
#[inline]
pub(crate) fn place(edges: &[f64], index: usize, t: f64) -> f64 {
    let (low, high) = (edges[index], edges[index + 1]);
    let x = low + t * (high - low);
    if x < high || index + 2 == edges.len() { x.min(high) } else { high.next_down() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_no_weight_are_never_picked() {
        let weights = [0.0, 2.0, 0.0, 1.0, 1.0, 0.0];
        let (bins, sum) = Bins::new("weights", &weights).unwrap();
        assert_eq!(sum, 4.0);
        for i in 0..=4096 {
            let u = f64::from(i) / 4096.0;
            let picked = bins.pick(u);
            assert!(weights[picked.index] > 0.0 && (0.0..1.0).contains(&picked.rest), "{u}: {picked:?}");
            assert!((bins.unpick(picked.index, picked.rest) - u).abs() < 1e-15);
            assert!(weights[bins.least(u)] > 0.0, "{u}");
        }
        assert_eq!([0.0, 0.4, 0.5, 0.6, 0.75, 0.8, 1.0].map(|u| bins.least(u)), [1, 1, 1, 3, 3, 4, 4]);
        assert_eq!(bins.pick(0.5), Picked { index: 3, rest: 0.0 });
    }

    #[test]
    fn intervals_hold_their_lower_edge() {
        let edges = [0.0, 1.0, 1.0_f64.next_up(), 3.0];
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0].map(|x| locate(&edges, x)), [0, 0, 1, 2, 2].map(Some));
        assert_eq!([-0.1, 3.1, f64::NAN].map(|x| locate(&edges, x)), [None; 3]);
        for index in 0..3 {
            for t in [0.0, 0.3, 1.0] {
                assert_eq!(locate(&edges, place(&edges, index, t)), Some(index));
            }
        }
    }
}
