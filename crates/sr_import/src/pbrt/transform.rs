//! The current transform, at the two times between which things may move.

use glam::{DMat4, DVec3};
use sr_scene::Span;

use super::Reader;
use super::params::Notes;
use super::state::Active;
use super::syntax::{Result, Scanner, SyntaxError};
use crate::look_at::look_at;
use crate::values::shown;

impl Reader<'_> {
    /// A directive that changes the current transform; false if `word` is none.
    pub(super) fn transform(&mut self, word: &str, s: &mut Scanner<'_>, span: &Span) -> Result<bool> {
        let mut v = [0.0; 16];
        let step = match word {
            "Identity" => {
                self.set_ctm([DMat4::IDENTITY; 2]);
                return Ok(true);
            }
            "Translate" => {
                s.numbers(&mut v[..3])?;
                DMat4::from_translation(DVec3::new(v[0], v[1], v[2]))
            }
            "Scale" => {
                s.numbers(&mut v[..3])?;
                DMat4::from_scale(DVec3::new(v[0], v[1], v[2]))
            }
            "Rotate" => {
                s.numbers(&mut v[..4])?;
                match DVec3::new(v[1], v[2], v[3]).try_normalize() {
                    Some(axis) => DMat4::from_axis_angle(axis, v[0].to_radians()),
                    None => {
                        self.error("pbrt::bad-transform", span, "the axis of a rotation cannot be zero");
                        DMat4::IDENTITY
                    }
                }
            }
            "LookAt" => {
                s.numbers(&mut v[..9])?;
                let point = |i: usize| DVec3::new(v[i], v[i + 1], v[i + 2]);
                match look_at(point(0), point(3), point(6)) {
                    Ok(world_from_camera) => world_from_camera.inverse(),
                    Err(reason) => {
                        self.error("pbrt::bad-transform", span, reason);
                        DMat4::IDENTITY
                    }
                }
            }
            "Transform" => {
                s.numbers(&mut v)?;
                self.set_ctm([DMat4::from_cols_array(&v); 2]);
                return Ok(true);
            }
            "ConcatTransform" => {
                s.numbers(&mut v)?;
                DMat4::from_cols_array(&v)
            }
            "CoordinateSystem" => {
                let name = s.string()?.0.into_owned();
                self.coordinate_systems.insert(name, [self.state.ctm, self.state.end_ctm]);
                return Ok(true);
            }
            "CoordSysTransform" => {
                let (name, bytes) = s.string()?;
                self.coordinate_system(&name, &Span { source: span.source, bytes });
                return Ok(true);
            }
            "ActiveTransform" => {
                let (which, bytes) = s.word();
                self.state.active = match which {
                    "StartTime" => Active::Start,
                    "EndTime" => Active::End,
                    "All" => Active::All,
                    _ => {
                        let message = "StartTime, EndTime or All was expected here".into();
                        return Err(SyntaxError { message, bytes });
                    }
                };
                return Ok(true);
            }
            "TransformTimes" => {
                s.numbers(&mut v[..2])?;
                return Ok(true);
            }
            _ => return Ok(false),
        };
        self.set_ctm([self.state.ctm * step, self.state.end_ctm * step]);
        Ok(true)
    }

    /// At the start and at the end, where they are active.
    pub(super) fn set_ctm(&mut self, [start, end]: [DMat4; 2]) {
        if self.state.active != Active::End {
            self.state.ctm = start;
        }
        if self.state.active != Active::Start {
            self.state.end_ctm = end;
        }
    }

    fn coordinate_system(&mut self, name: &str, span: &Span) {
        match self.coordinate_systems.get(name) {
            Some(&ctm) => self.set_ctm(ctm),
            None => {
                let message = format!("there is no coordinate system \"{}\"", shown(name));
                let mut notes = Notes { list: self.out.d, said: &mut self.said };
                let known = self.coordinate_systems.keys();
                Self::unresolved(&mut notes, span, message, name, known, "the transform stays as it is");
            }
        }
    }
}
