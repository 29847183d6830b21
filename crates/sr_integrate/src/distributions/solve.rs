//! Where an increasing function reaches a value.

/// The x in [low, high] with f(x) = `target`, of a function that never falls, from its value and slope.
///
/// Newton's steps while they stay between the bounds known so far, halving where they do not; the bounds
/// close in on the solution until no number lies between. `guess` may be anything.
pub(crate) fn increasing(
    f: impl Fn(f64) -> (f64, f64),
    target: f64,
    [mut low, mut high]: [f64; 2],
    guess: f64,
) -> f64 {
    let mut x = guess;
    let mut last_step = f64::INFINITY;
    for _ in 0..200 {
        if !(x >= low && x <= high) {
            x = middle(low, high);
            last_step = f64::INFINITY;
        }
        let (value, slope) = f(x);
        let excess = value - target;
        if excess == 0.0 {
            return x;
        }
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let mut next = x - excess / slope;
        let mut step = (next - x).abs();
        // Not `<`, so that NaN halves too.
        if !(next > low && next < high && step < 0.75 * last_step) {
            if step <= f64::EPSILON * x.abs() {
                return x; // no closer number
            }
            next = middle(low, high);
            step = f64::INFINITY;
        }
        if next == x || next <= low || next >= high {
            return x;
        }
        if step <= f64::EPSILON * x.abs() {
            return next;
        }
        last_step = step;
        x = next;
    }
    x
}

/// A number between two others; halves the exponent if they are far apart.
fn middle(low: f64, high: f64) -> f64 {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => 0.5 * low + 0.5 * high,
        (true, false) => 2.0 * low.max(0.5) + 1.0,
        (false, true) => 2.0 * high.min(-0.5) - 1.0,
        (false, false) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steep_flat_and_jumping_functions() {
        let cube = |x: f64| (x * x * x, 3.0 * x * x);
        assert!((increasing(cube, 8.0, [-5.0, 5.0], 0.0) - 2.0).abs() < 1e-15);
        assert!((increasing(cube, 8.0, [-f64::INFINITY, f64::INFINITY], f64::NAN) - 2.0).abs() < 1e-15);
        let step = |x: f64| if x < 0.3 { (0.0, 0.0) } else { (1.0, 0.0) };
        assert!((increasing(step, 0.5, [0.0, 1.0], 0.9) - 0.3).abs() < 1e-15);
        assert!((increasing(|x| (x, 1.0), 0.25, [0.0, 1.0], 7.0) - 0.25).abs() < 1e-16);
    }
}
