//! The attributes of an XML element, with a note of those that were asked for.

use glam::DVec3;
use roxmltree::Node as Element;

use crate::values::{number, numbers};

/// The attributes of one element, with `$name` already substituted.
pub struct Attributes<'a, 'input> {
    element: Element<'a, 'input>,
    values: Vec<(&'a str, String)>,
    used: Vec<bool>,
}

impl<'a, 'input> Attributes<'a, 'input> {
    /// `values` are the element's attributes after substitution.
    pub fn new(element: Element<'a, 'input>, values: Vec<(&'a str, String)>) -> Self {
        let used = vec![false; values.len()];
        Self { element, values, used }
    }

    /// The text of an attribute.
    pub fn text(&mut self, name: &str) -> Option<&str> {
        let at = self.values.iter().position(|(n, _)| *n == name)?;
        self.used[at] = true;
        Some(&self.values[at].1)
    }

    /// The text of an attribute that has to be there.
    pub fn required(&mut self, name: &str) -> Result<&str, String> {
        let tag = self.element.tag_name().name().to_owned();
        self.text(name).ok_or_else(|| format!("<{tag}> needs the attribute \"{name}\""))
    }

    /// A number.
    pub fn number(&mut self, name: &str) -> Result<Option<f64>, String> {
        self.text(name).map(number).transpose()
    }

    /// A list of numbers.
    pub fn numbers(&mut self, name: &str) -> Result<Option<Vec<f64>>, String> {
        self.text(name).map(numbers).transpose()
    }

    /// `x`, `y`, `z`, each `default` if absent, or `value` with three numbers or one for all.
    pub fn vector(&mut self, default: f64) -> Result<DVec3, String> {
        if let Some(values) = self.numbers("value")? {
            return match values[..] {
                [v] => Ok(DVec3::splat(v)),
                [x, y, z] => Ok(DVec3::new(x, y, z)),
                _ => Err(format!("three numbers were expected, not {}", values.len())),
            };
        }
        let mut part = |name| Ok::<_, String>(self.number(name)?.unwrap_or(default));
        Ok(DVec3::new(part("x")?, part("y")?, part("z")?))
    }

    /// The names of attributes that nothing asked for.
    pub fn unused(&self) -> impl Iterator<Item = &str> {
        self.values.iter().zip(&self.used).filter(|(_, used)| !**used).map(|((name, _), _)| *name)
    }
}
