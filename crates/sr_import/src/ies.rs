//! Measured luminaires in files of the IES: ANSI/IES LM-63 of 1986 to 2019, photometry of type C.
//!
//! In: the bytes of a file. Out: an [`IntensityProfile`] in candelas, multipliers and ballast factors applied, or half a
//! sentence that says what is wrong where. Keywords are skipped; lamps are taken as upright (the tilt is read past).

use sr_scene::IntensityProfile;

/// Larger files are refused.
pub const MAX_BYTES: u64 = 16 << 20;
/// More angles along one axis are refused.
const MAX_ANGLES: usize = 10_000;

/// What a file's words stand for, one number after another.
struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
}

impl<'a> Numbers<'a> {
    /// Of the lines from `first_line` on; numbers are separated by blanks and, in old files, commas.
    fn new(lines: &'a [&'a str], first_line: usize) -> Self {
        let words = lines.iter().enumerate().flat_map(move |(i, line)| {
            let words = line.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
            words.map(move |word| (first_line + i + 1, word))
        });
        Self { words: Box::new(words) }
    }

    /// The next number, called `what` if it is none.
    fn next(&mut self, what: &str) -> Result<f64, String> {
        let Some((line, word)) = self.words.next() else { return Err(format!("it ends before {what}")) };
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let word: String = word.chars().take(24).collect::<String>().escape_debug().collect();
                Err(format!("line {line}: \"{word}\" is not {what}"))
            }
        }
    }

    /// A count of angles.
    fn count(&mut self, what: &str) -> Result<usize, String> {
        let value = self.next(what)?;
        if value.fract() == 0.0 && (1.0..=MAX_ANGLES as f64).contains(&value) {
            return Ok(value as usize);
        }
        Err(format!("{what} is {value}; whole numbers from 1 to {MAX_ANGLES} are read"))
    }

    /// Angles in degrees, each above the one before.
    fn angles(&mut self, count: usize, what: &str) -> Result<Vec<f64>, String> {
        let mut angles: Vec<f64> = Vec::new();
        for _ in 0..count {
            let angle = self.next(what)?;
            if let Some(&last) = angles.last()
                && angle <= last
            {
                return Err(format!("{what} {angle} follows {last}: angles have to rise"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}

/// Reads a file; `name` is what messages will call it.
pub fn parse(name: &str, bytes: &[u8]) -> Result<IntensityProfile, String> {
    let text = String::from_utf8_lossy(bytes);
    let lines: Vec<&str> = text.lines().collect();
    // Before 1991 the first line had no mark of the format; TILT= ends the keywords in all of them.
    let (at, tilt) = lines
        .iter()
        .enumerate()
        .find_map(|(i, line)| Some((i, line.trim().strip_prefix("TILT=")?.trim())))
        .ok_or("it is no IES file: it has no line \"TILT=\"")?;
    let mut numbers = Numbers::new(&lines[at + 1..], at + 1);
    // Otherwise NONE, or a file with factors for lamps that are not upright.
    if tilt == "INCLUDE" {
        numbers.next("the lamp's position (TILT=INCLUDE)")?;
        let pairs = numbers.count("the number of tilt angles")?;
        for _ in 0..2 * pairs {
            numbers.next("a tilt angle or factor")?;
        }
    }
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let multiplier = numbers.next("the multiplier of candelas")?;
    let vertical_count = numbers.count("the number of vertical angles")?;
    let horizontal_count = numbers.count("the number of horizontal angles")?;
    let kind = numbers.next("the photometric type")?;
    for what in ["the unit of lengths", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    let ballast = numbers.next("the ballast factor")?;
    // of 1986: the ballast–lamp factor; later: for future use, and 1
    let ballast_lamp = numbers.next("the ballast-lamp factor")?;
    numbers.next("the watts")?;
    if kind != 1.0 {
        let letter = if kind == 2.0 { "B" } else { "A" };
        return Err(format!("its photometry is of type {letter} ({kind}); type C (1) is read"));
    }
    let factor = multiplier * ballast * ballast_lamp;
    if !(factor >= 0.0) {
        return Err(format!("its multiplier and ballast factors make {factor}"));
    }
    let vertical = numbers.angles(vertical_count, "a vertical angle")?;
    let horizontal = numbers.angles(horizontal_count, "a horizontal angle")?;
    if vertical[0] < 0.0 || vertical[vertical.len() - 1] > 180.0 {
        return Err("its vertical angles are not within 0° to 180°".into());
    }
    let mut candelas = Vec::new();
    for _ in 0..vertical_count * horizontal_count {
        let value = numbers.next("an intensity")? * factor;
        if !(0.0..=f64::from(f32::MAX)).contains(&value) {
            return Err(format!("an intensity is {value} cd"));
        }
        candelas.push(value as f32);
    }
    let (horizontal, candelas) = from_zero(horizontal, candelas, vertical_count)?;
    let radians = |angles: Vec<f64>| angles.into_iter().map(|a| a.to_radians() as f32).collect();
    Ok(IntensityProfile {
        name: name.into(),
        vertical: radians(vertical),
        horizontal: radians(horizontal),
        candelas,
    })
}

/// Horizontal angles that start at 0 and end at 0, 90, 180 or 360 (or before it, the first closing the turn). A half
/// that was measured from 90 to 270, mirrored about the plane of 90, becomes all of the turn.
fn from_zero(horizontal: Vec<f64>, candelas: Vec<f32>, rows: usize) -> Result<(Vec<f64>, Vec<f32>), String> {
    let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
    let is = |a: f64, b: f64| (a - b).abs() < 1e-3;
    if is(first, 0.0)
        && (last > 180.0 && last <= 360.0 + 1e-3 || [0.0, 90.0, 180.0].iter().any(|&end| is(last, end)))
    {
        return Ok((horizontal, candelas));
    }
    if is(first, 90.0) && is(last, 270.0) {
        let mut turn: Vec<(f64, &[f32])> = Vec::new();
        for (&angle, web) in horizontal.iter().zip(candelas.chunks_exact(rows)) {
            turn.push((angle, web));
            // mirrored about the plane of 90 and 270
            let mirrored = (540.0 - angle) % 360.0;
            if !is(mirrored, angle) {
                turn.push((mirrored, web));
            }
        }
        turn.sort_by(|a, b| a.0.total_cmp(&b.0));
        if turn[0].0 > 1e-3 {
            return Err("its horizontal angles from 90° to 270° lack 180°".into());
        }
        let candelas = turn.iter().flat_map(|(_, web)| web.iter().copied()).collect();
        return Ok((turn.into_iter().map(|(angle, _)| angle).collect(), candelas));
    }
    Err(format!(
        "its horizontal angles go from {first}° to {last}°; 0 to 0, 90, 180 or 360 and 90 to 270 are read"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] none\nTILT=NONE\n";

    fn parsed(text: &str) -> Result<IntensityProfile, String> {
        parse("test.ies", text.as_bytes())
    }

    #[test]
    fn factors_multiply_and_angles_become_radians() {
        let body = "1 1000 2.0 3 2 1 2 0 0 0\n0.5 1 50\n0 45 90\n0, 90\n10 20 30\n40 50 60\n";
        let p = parsed(&format!("{HEAD}{body}")).unwrap();
        assert_eq!(p.candelas, [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
        assert!((p.vertical[1] - 45f32.to_radians()).abs() < 1e-6 && p.horizontal.len() == 2);
    }

    #[test]
    fn a_tilt_table_is_read_past() {
        let text = "old file\nTILT=INCLUDE\n1\n2\n0 90\n1.0 0.8\n1 -1 1 2 1 1 1 0 0 0 1 1 5 0 90 0 7 8";
        assert_eq!(parsed(text).unwrap().candelas, [7.0, 8.0]);
    }

    #[test]
    fn a_half_about_90_becomes_a_turn() {
        let body = "1 1000 1 1 3 1 2 0 0 0 1 1 50 0 90 180 270 5 6 7";
        let p = parsed(&format!("{HEAD}{body}")).unwrap();
        let degrees: Vec<f32> = p.horizontal.iter().map(|a| a.to_degrees().round()).collect();
        assert_eq!((degrees, p.candelas), (vec![0.0, 90.0, 180.0, 270.0], vec![6.0, 5.0, 6.0, 7.0]));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let sound = "1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 5 6";
        assert!(parsed(&format!("{HEAD}{sound}")).is_ok());
        for (body, says) in [
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 5", "ends before an intensity"),
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 90 0 0 5 6", "have to rise"),
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 5 x", "line 5: \"x\" is not an intensity"),
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 5 nan", "is not an intensity"),
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 5 -6", "-6 cd"),
            ("1 1000 1 2 1 3 2 0 0 0 1 1 50 0 90 0 5 6", "type A (3)"),
            ("1 1000 1 0 1 1 2 0 0 0 1 1 50 0 90 0 5 6", "is 0; whole numbers"),
            ("1 1000 1 99999999 99999999 1 2 0 0 0 1 1 50", "whole numbers from 1"),
            ("1 1000 1 9999 9999 1 2 0 0 0 1 1 50 0", "ends before a vertical angle"),
            ("1 1000 1 2 1 1 2 0 0 0 1 1 50 0 190 0 5 6", "0° to 180°"),
            ("1 1000 1 1 2 1 2 0 0 0 1 1 50 0 10 50 5 6", "from 10° to 50°"),
        ] {
            let error = parsed(&format!("{HEAD}{body}")).unwrap_err();
            assert!(error.contains(says), "{body}: {error}");
        }
        assert!(parsed("hello").unwrap_err().contains("no IES file"));
    }
}
