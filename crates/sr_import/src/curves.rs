//! Mitsuba's files of curves: a control point on each line, `x y z radius`, and blank lines between curves.

use std::path::Path;

use glam::{DMat4, DVec3, Vec4};
use rayon::prelude::*;
use sr_scene::{CurveBasis, CurveUv, CurvesDesc};

use crate::files;
use crate::limits::{Limit, Limits};
use crate::values::shown;

/// About so many bytes are read at a time, side by side.
const BLOCK: usize = 1 << 20;

/// Curves, and a sentence about what was not read of them, if there is something.
pub type Read = (CurvesDesc, Option<String>);

/// Reads a file and places its points. Radii stay as they are, as in Mitsuba. The error is half a sentence.
pub fn load(path: &Path, basis: CurveBasis, to_world: &DMat4, limits: &Limits) -> Result<Read, String> {
    let bytes = files::unpacked(files::read(path, limits.file_bytes)?, limits.unpacked_bytes)?;
    let (mut curves, note) = parse(&bytes, basis, limits.mesh_elements)?;
    curves.name = path.display().to_string();
    curves.points.par_iter_mut().for_each(|p| {
        let [x, y, z, radius] = p.to_array();
        *p = to_world.transform_point3(DVec3::new(x.into(), y.into(), z.into())).as_vec3().extend(radius);
    });
    if let Some(bad) = curves.points.iter().position(|p| !p.is_finite()) {
        return Err(format!("control point {bad} is out of range after its transform"));
    }
    Ok((curves, note))
}

/// What lines say.
#[derive(Default)]
struct Block {
    lines: usize,
    points: Vec<Vec4>,
    /// Before which points there are blank lines.
    breaks: Vec<usize>,
    /// The first line with more than four numbers.
    long: Option<usize>,
}

fn parse(bytes: &[u8], basis: CurveBasis, limit: Limit) -> Result<Read, String> {
    let blocks: Vec<Result<Block, (usize, String)>> = blocks(bytes).into_par_iter().map(block).collect();
    let name = String::new();
    let mut curves =
        CurvesDesc { name, basis, uv: CurveUv::AroundAlong, points: Vec::new(), firsts: Vec::new() };
    let (mut lines, mut long) = (0, None);
    for block in blocks {
        let block = block.map_err(|(line, reason)| format!("line {}: {reason}", lines + line))?;
        let first = curves.points.len();
        if first + block.points.len() > limit.len() {
            return Err(limit.refusal(format!("more than {limit} control points")));
        }
        curves.firsts.extend(block.breaks.iter().map(|at| (first + at) as u32));
        curves.points.extend_from_slice(&block.points);
        long = long.or(block.long.map(|line| lines + line));
        lines += block.lines;
    }
    if curves.points.is_empty() {
        return Err("it has no control points".into());
    }
    curves.firsts.insert(0, 0);
    // Several blank lines are as good as one, and at the end they begin nothing.
    curves.firsts.dedup();
    curves.firsts.retain(|&first| (first as usize) < curves.points.len());
    if let Some(wrong) = curves.curves().position(|points| basis.segments(points.len()).is_none()) {
        let count = curves.curves().nth(wrong).map_or(0, <[Vec4]>::len);
        let order = basis.order();
        return Err(format!("curve {} has {count} control points; at least {order} are needed", wrong + 1));
    }
    if let Some(fault) = curves.fault() {
        return Err(fault);
    }
    let note = long.map(|line| format!("line {line} has more than four numbers"));
    Ok((curves, note))
}

/// The bytes in pieces that end where lines do.
fn blocks(mut bytes: &[u8]) -> Vec<&[u8]> {
    let mut blocks = Vec::new();
    while !bytes.is_empty() {
        let end = bytes.iter().skip(BLOCK).position(|&b| b == b'\n').map_or(bytes.len(), |at| BLOCK + at + 1);
        let (block, rest) = bytes.split_at(end.min(bytes.len()));
        blocks.push(block);
        bytes = rest;
    }
    blocks
}

/// Reads lines; the error has the line's number, from 1.
fn block(bytes: &[u8]) -> Result<Block, (usize, String)> {
    let mut block = Block::default();
    let bytes = bytes.strip_suffix(b"\n").unwrap_or(bytes);
    for line in bytes.split(|&b| b == b'\n') {
        block.lines += 1;
        let fail = |reason| (block.lines, reason);
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).peekable();
        if words.peek().is_none() {
            block.breaks.push(block.points.len());
            continue;
        }
        let mut number = || number(words.next());
        let point = (|| Ok([number()?, number()?, number()?, number()?]))().map_err(fail)?;
        let point = Vec4::from(point);
        block.points.push(point);
        if words.next().is_some() {
            block.long.get_or_insert(block.lines);
        }
    }
    Ok(block)
}

fn number(word: Option<&[u8]>) -> Result<f32, String> {
    let word = word.ok_or("fewer than four numbers")?;
    let text = String::from_utf8_lossy(word);
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("\"{}\" is no finite number", shown(&text))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(bytes: &[u8], basis: CurveBasis) -> Result<Read, String> {
        super::parse(bytes, basis, Limit::fixed(1 << 20))
    }

    #[test]
    fn blank_lines_are_between_curves() {
        let text = "\n \r\n0 0 0 1\r\n1 0 0 1e-1\n\n\t\n0 1 0 .5\n 1\t1  0 0 \n2 1 0 0\n\n";
        let (curves, note) = parse(text.as_bytes(), CurveBasis::Linear).unwrap();
        assert_eq!((&curves.firsts[..], curves.points.len(), note), (&[0, 2][..], 5, None));
        assert_eq!(curves.points[1], Vec4::new(1.0, 0.0, 0.0, 0.1));
    }

    #[test]
    fn many_blocks_are_one_file() {
        let curve = "0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n\n";
        let count = 3 * BLOCK / curve.len();
        let (curves, _) = parse(curve.repeat(count).as_bytes(), CurveBasis::BSpline).unwrap();
        assert_eq!((curves.firsts.len(), curves.points.len()), (count, 4 * count));
        let bad = curve.repeat(count) + "1 2 x 4\n";
        let error = parse(bad.as_bytes(), CurveBasis::BSpline).unwrap_err();
        assert_eq!(error, format!("line {}: \"x\" is no finite number", 5 * count + 1));
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, reason) in [
            ("", "it has no control points"),
            ("\n\n", "it has no control points"),
            ("0 0 0 1\n0 0 1", "line 2: fewer than four numbers"),
            ("0 0 0 1\n0 0 1 nan", "line 2: \"nan\" is no finite number"),
            ("0 0 0 1\n0 0 1e39 1", "line 2: \"1e39\" is no finite number"),
            ("0 0 0 1\n0 0 1 -2", "a control point at [0, 0, 1] of radius -2"),
            ("0 0 0 1\n1 0 0 1\n\n0 0 0 1\n", "curve 2 has 1 control points; at least 2 are needed"),
        ] {
            assert_eq!(parse(text.as_bytes(), CurveBasis::Linear).unwrap_err(), reason);
        }
        let (_, note) = parse(b"0 0 0 1\n1 0 0 1 7\n2 0 0 1", CurveBasis::Linear).unwrap();
        assert_eq!(note.unwrap(), "line 2 has more than four numbers");
    }
}
