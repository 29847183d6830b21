//! The command line.

use std::path::PathBuf;
use std::str::FromStr;

/// What `--help` says.
pub const HELP: &str = "\
bench_rays SCENE... [--embree LIBRARY] [--rays N] [--runs N] [--threads N]

SCENE: box                  38 triangles: walls, two blocks and a lamp
       scattered:N          N triangles scattered in a cube; rays leave them in random directions
       mesh:N               a bumpy sphere of about N triangles; rays leave it in random directions
       primary:N            the same, seen through a pinhole, neighbouring rays one after another
       forest:KxN           K instances of a bumpy sphere of about N triangles
--embree LIBRARY            libembree4; without it only our own rows are printed
--rays N                    rays for each measurement (65536)
--runs N                    turns that all contenders take (7)
--threads N                 for building; rays are met on one (2)";

/// What is asked for.
pub struct Arguments {
    /// In this order.
    pub scenes: Vec<SceneName>,
    /// Embree's shared library.
    pub embree: Option<PathBuf>,
    /// Rays for each measurement.
    pub rays: usize,
    /// Turns that all contenders take.
    pub runs: usize,
    /// For building.
    pub threads: usize,
}

/// A scene with its size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneName {
    /// Walls, two blocks and a lamp.
    Box,
    /// Scattered triangles.
    Scattered(usize),
    /// A bumpy sphere.
    Mesh(usize),
    /// A bumpy sphere seen by a camera.
    Primary(usize),
    /// Instances of a bumpy sphere.
    Forest {
        /// How many.
        instances: usize,
        /// Triangles of each.
        triangles: usize,
    },
}

impl FromStr for SceneName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let unknown = || format!("there is no scene {text:?}; --help lists them");
        let count = |text: &str| text.parse::<usize>().ok().filter(|&n| n > 0).ok_or_else(unknown);
        let (kind, size) = text.split_once(':').unwrap_or((text, ""));
        match kind {
            "box" if size.is_empty() => Ok(Self::Box),
            "scattered" => Ok(Self::Scattered(count(size)?)),
            "mesh" => Ok(Self::Mesh(count(size)?)),
            "primary" => Ok(Self::Primary(count(size)?)),
            "forest" => {
                let (instances, triangles) = size.split_once('x').ok_or_else(unknown)?;
                Ok(Self::Forest { instances: count(instances)?, triangles: count(triangles)? })
            }
            _ => Err(unknown()),
        }
    }
}

impl std::fmt::Display for SceneName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Box => write!(f, "box"),
            Self::Scattered(n) => write!(f, "scattered:{n}"),
            Self::Mesh(n) => write!(f, "mesh:{n}"),
            Self::Primary(n) => write!(f, "primary:{n}"),
            Self::Forest { instances, triangles } => write!(f, "forest:{instances}x{triangles}"),
        }
    }
}

impl Arguments {
    /// `None`: help is wanted.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut out = Self { scenes: Vec::new(), embree: None, rays: 1 << 16, runs: 7, threads: 2 };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            let number = |text: String| {
                text.parse()
                    .ok()
                    .filter(|&n| n > 0)
                    .ok_or_else(|| format!("{word} takes a number, not {text:?}"))
            };
            match word.as_str() {
                "-h" | "--help" => return Ok(None),
                "--embree" => out.embree = Some(value()?.into()),
                "--rays" => out.rays = number(value()?)?,
                "--runs" => out.runs = number(value()?)?,
                "--threads" => out.threads = number(value()?)?,
                scene => out.scenes.push(scene.parse()?),
            }
        }
        if out.scenes.is_empty() {
            Err("no scene was named; --help lists them".into())
        } else {
            Ok(Some(out))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Option<Arguments>, String> {
        Arguments::parse(line.split_whitespace().map(String::from))
    }

    #[test]
    fn scenes_are_written_as_they_are_read() {
        for name in ["box", "scattered:1000", "mesh:12", "primary:5", "forest:10x300"] {
            assert_eq!(name.parse::<SceneName>().unwrap().to_string(), name);
        }
        for name in ["", "bux", "box:3", "mesh", "mesh:0", "forest:3", "forest:x3"] {
            assert!(name.parse::<SceneName>().is_err(), "{name}");
        }
    }

    #[test]
    fn the_command_line() {
        let given = parse("box --runs 3 mesh:12 --embree lib.so").unwrap().unwrap();
        assert_eq!(given.scenes, [SceneName::Box, SceneName::Mesh(12)]);
        assert_eq!((given.runs, given.rays, given.threads), (3, 1 << 16, 2));
        assert_eq!(given.embree.unwrap().to_str(), Some("lib.so"));
        assert!(parse("--help").unwrap().is_none());
        for line in ["", "box --runs", "box --runs x", "box --rays 0"] {
            assert!(parse(line).is_err(), "{line}");
        }
    }
}
