//! MTL: the materials of an OBJ file, as they are written. What they mean is in `cover`.

use std::collections::{BTreeMap, HashMap};

use glam::Vec2;
use sr_scene::{Diagnostic, Diagnostics, Rgb, SourceId, Span};

use crate::values::{number, shown};

/// Statements of one number.
const NUMBERS: &[&str] = &["ns", "d", "tr", "ni", "illum", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"];
/// Statements of three numbers, or one that stands for three.
const COLORS: &[&str] = &["ka", "kd", "ks", "ke", "tf"];
/// Statements that name an image, and their other names.
const MAPS: &[(&str, &str)] = &[
    ("map_kd", "map_kd"),
    ("map_ks", "map_ks"),
    ("map_ke", "map_ke"),
    ("map_d", "map_d"),
    ("map_bump", "map_bump"),
    ("bump", "map_bump"),
    ("norm", "norm"),
    ("map_pr", "map_pr"),
    ("map_pm", "map_pm"),
];
/// What stands for light that is traced here.
const TRACED: &[&str] = &["ka", "map_ka"];

/// A material.
#[derive(Clone, Debug, Default)]
pub struct Mtl {
    /// Where it begins.
    pub span: Span,
    numbers: BTreeMap<&'static str, [f32; 3]>,
    maps: BTreeMap<&'static str, Map>,
}

/// An image, and how it lies on the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// As the file has it, with slashes.
    pub file: String,
    /// Of the coordinates.
    pub scale: Vec2,
    /// Of the coordinates, after scaling.
    pub offset: Vec2,
    /// Does its border continue?
    pub clamp: bool,
    /// What bumps are multiplied by.
    pub bump: f32,
    /// Its statement.
    pub span: Span,
}

impl Mtl {
    /// A number.
    pub fn number(&self, name: &str) -> Option<f32> {
        self.numbers.get(name).map(|v| v[0])
    }

    /// Three of them.
    pub fn color(&self, name: &str) -> Option<Rgb> {
        self.numbers.get(name).map(|&v| Rgb::from_array(v))
    }

    /// An image.
    pub fn map(&self, name: &str) -> Option<&Map> {
        self.maps.get(name)
    }
}

/// Reads a file's materials, by their names; the first of a name counts.
pub fn parse(text: &str, source: SourceId, d: &mut Diagnostics) -> HashMap<String, Mtl> {
    let mut found: HashMap<String, Mtl> = HashMap::new();
    let mut open: Option<(String, Mtl)> = None;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let place = start;
        start += line.len();
        let statement = line.trim();
        if statement.is_empty() || statement.starts_with('#') {
            continue;
        }
        let at = place + (line.len() - line.trim_start().len());
        let span = Span { source, bytes: at..at + statement.len() };
        let (word, rest) = statement.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((statement, ""));
        if word.eq_ignore_ascii_case("newmtl") {
            found.extend(open.take().filter(|(name, _)| !found.contains_key(name)));
            open = Some((rest.trim().to_owned(), Mtl { span, ..Mtl::default() }));
        } else if let Some((_, material)) = &mut open {
            if let Err((message, consequence)) = material.state(&word.to_ascii_lowercase(), rest, &span) {
                d.push(Diagnostic::warning("mtl::statement", &span, message).consequence(consequence));
            }
        } else {
            let message = "a statement before the first \"newmtl\" belongs to no material";
            d.push(Diagnostic::warning("mtl::statement", &span, message).consequence("it is ignored"));
        }
    }
    found.extend(open.filter(|(name, _)| !found.contains_key(name)));
    found
}

/// What is wrong, and what happens instead.
type Problem = (String, &'static str);

impl Mtl {
    fn state(&mut self, word: &str, rest: &str, span: &Span) -> Result<(), Problem> {
        // A comment may follow numbers; in a file's name "#" is a letter.
        let uncommented = rest.split('#').next().unwrap_or("");
        if TRACED.contains(&word) {
            return Ok(());
        }
        if let Some(name) = NUMBERS.iter().find(|&&name| name == word) {
            let (halo, value) = match uncommented.trim().strip_prefix("-halo") {
                Some(value) => (true, value),
                None => (false, uncommented),
            };
            let value = finite(value).map_err(|reason| (reason, "the statement is ignored"))?;
            self.numbers.insert(name, [value; 3]);
            return match halo {
                true => {
                    Err(("opacity does not depend on the angle".into(), "it is the same from everywhere"))
                }
                false => Ok(()),
            };
        }
        if let Some(name) = COLORS.iter().find(|&&name| name == word) {
            let values: Result<Vec<f32>, String> = uncommented.split_ascii_whitespace().map(finite).collect();
            let color = match values.map_err(|reason| (reason, "the statement is ignored"))?[..] {
                [grey] => [grey; 3],
                [r, g, b] => [r, g, b],
                _ => return Err(("a color has one number or three".into(), "the statement is ignored")),
            };
            self.numbers.insert(name, color);
            return Ok(());
        }
        if let Some((_, name)) = MAPS.iter().find(|(name, _)| *name == word) {
            let (map, ignored) = Map::parse(rest, span).map_err(|r| (r, "the image is not used"))?;
            self.maps.insert(name, map);
            return match ignored {
                Some(option) => {
                    Err((format!("the option \"{option}\" of an image is not done"), "it is ignored"))
                }
                None => Ok(()),
            };
        }
        Err((format!("\"{}\" is not done", shown(word)), "it is ignored"))
    }
}

impl Map {
    /// Options, then a file's name, which may have spaces; and the first option that is not done.
    fn parse(text: &str, span: &Span) -> Result<(Self, Option<String>), String> {
        let mut map = Self {
            file: String::new(),
            scale: Vec2::ONE,
            offset: Vec2::ZERO,
            clamp: false,
            bump: 1.0,
            span: span.clone(),
        };
        let mut ignored = None;
        let mut rest = text.trim();
        while let Some(option) = rest.strip_prefix('-') {
            let (option, after) = next_word(option);
            rest = after;
            let mut values: Vec<f32> = Vec::new();
            // So many that are no numbers, and at most so many that are.
            let (words, numbers) = match option {
                "s" | "o" | "t" => (0, 3),
                "mm" => (0, 2),
                "bm" | "boost" | "texres" => (0, 1),
                "clamp" | "blendu" | "blendv" | "cc" | "imfchan" | "type" | "colorspace" => (1, 0),
                _ => return Err(format!("\"-{}\" is no option of an image", shown(option))),
            };
            let mut word = "";
            for _ in 0..words {
                (word, rest) = next_word(rest);
            }
            while values.len() < numbers {
                let (word, after) = next_word(rest);
                // The last word is the file, even if it is a number.
                let Some(value) = finite(word).ok().filter(|_| !after.is_empty()) else { break };
                values.push(value);
                rest = after;
            }
            let pair = |default: f32| {
                Vec2::new(
                    values.first().copied().unwrap_or(default),
                    values.get(1).copied().unwrap_or(default),
                )
            };
            match option {
                "s" => map.scale = pair(1.0),
                "o" => map.offset = pair(0.0),
                "bm" => map.bump = pair(1.0).x,
                "clamp" => map.clamp = word == "on",
                // What filters would do, and what the image itself says.
                "blendu" | "blendv" | "texres" | "boost" => {}
                _ => ignored = ignored.or_else(|| Some(format!("-{option}"))),
            }
        }
        if rest.is_empty() {
            return Err("no file is named".into());
        }
        map.file = rest.replace('\\', "/");
        Ok((map, ignored))
    }
}

fn next_word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    let (word, rest) = text.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((text, ""));
    (word, rest.trim_start())
}

/// A number that a float holds.
fn finite(text: &str) -> Result<f32, String> {
    let value = number(text)? as f32;
    if value.is_finite() { Ok(value) } else { Err(format!("\"{}\" is too large", shown(text.trim()))) }
}
