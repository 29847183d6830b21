//! Directives, one by one: attributes and other files are carried out here, the others where their subject is.

use std::rc::Rc;

use glam::DMat4;
use sr_scene::{Diagnostic, SourceId, Span};

use super::params::Params;
use super::state::{Active, Inherited, Saved, State};
use super::syntax::{Result, Scanner, SyntaxError, Text};
use super::{Reader, support};
use crate::color_space::ColorSpace;
use crate::limits::Limits;
use crate::values::shown;

/// Files within files, and attributes within attributes.
const MAX_DEPTH: usize = 64;

/// Parameters that `Attribute` may give to one kind of directive, and values of one of them: each directive has them.
const MAX_ATTRIBUTES: usize = 256;

impl Reader<'_> {
    /// Carries out a text. What cannot be understood is an error, and the end.
    pub(super) fn run(&mut self, text: &mut Text, source: SourceId) {
        let mut scanner = Scanner::new(text);
        while !self.is_broken && scanner.peek().is_some() {
            if let Err(SyntaxError { message, bytes }) = self.directive(&mut scanner, source) {
                self.error("pbrt::syntax", &Span { source, bytes }, message);
                self.is_broken = true;
            }
        }
    }

    fn directive(&mut self, s: &mut Scanner<'_>, source: SourceId) -> Result<()> {
        let (word, bytes) = s.word();
        if word.is_empty() {
            return Err(s.unexpected("a directive"));
        }
        let span = Span { source, bytes };
        match word {
            "AttributeBegin" => self.save(Saved::Attribute(Box::new(self.state.clone()), span)),
            "TransformBegin" => {
                let State { ctm, end_ctm, active, .. } = self.state;
                self.save(Saved::Transform(Box::new(([ctm, end_ctm], active)), span));
            }
            "AttributeEnd" | "TransformEnd" | "ObjectEnd" => self.restore(word, &span),
            "ObjectBegin" => {
                let name = s.string()?.0;
                self.object_begin(&name, span);
            }
            "ObjectInstance" => {
                let name = s.string()?.0;
                self.object_instance(&name, &span);
            }
            "Include" | "Import" => {
                let (name, bytes) = s.string()?;
                self.include(&name, &Span { source, bytes });
            }
            "WorldBegin" => {
                self.options_end(&span);
                self.state.active = Active::All;
                self.set_ctm([DMat4::IDENTITY; 2]);
                self.coordinate_systems.insert("world".into(), [DMat4::IDENTITY; 2]);
            }
            // It ends nothing in pbrt-v4.
            "WorldEnd" => {}
            "ReverseOrientation" => self.state.reverse_orientation ^= true,
            "ColorSpace" => {
                let (name, bytes) = s.string()?;
                self.color_space(&name, &Span { source, bytes });
            }
            "Attribute" => self.attribute(s, &span)?,
            "Option" => self.option(s, &span)?,
            "NamedMaterial" => {
                let (name, bytes) = s.string()?;
                self.named_material(&name, &Span { source, bytes });
            }
            "MediumInterface" => {
                s.string()?;
                if s.peek() == Some(b'"') {
                    s.string()?;
                }
            }
            "Texture" => self.texture_directive(s, span)?,
            "Camera" | "Film" | "PixelFilter" | "Sampler" | "Integrator" | "Accelerator" | "Material"
            | "MakeNamedMaterial" | "MakeNamedMedium" | "LightSource" | "AreaLightSource" | "Shape" => {
                self.typed(word, s, span)?;
            }
            _ => {
                if !self.transform(word, s, &span)? {
                    return Err(unknown(word, span.bytes));
                }
            }
        }
        Ok(())
    }

    /// Directives of the form `Shape "sphere"` and parameters.
    fn typed(&mut self, word: &str, s: &mut Scanner<'_>, mut span: Span) -> Result<()> {
        let (kind, bytes) = s.string()?;
        span.bytes.end = bytes.end;
        let list = s.parameters()?;
        let attributes = &self.state.attributes;
        let inherited: Inherited = match word {
            "Shape" => attributes.shape.clone(),
            "LightSource" | "AreaLightSource" => attributes.light.clone(),
            "Material" | "MakeNamedMaterial" => attributes.material.clone(),
            "MakeNamedMedium" => attributes.medium.clone(),
            _ => Inherited::default(),
        };
        if matches!(word, "Camera" | "LightSource" | "Shape") && self.state.ctm != self.state.end_ctm {
            let message = "motion between two times is not supported";
            self.warn("pbrt::motion", &span, message, "everything is where it is at the first one");
        }
        let params = Params::new(format!("{word} \"{}\"", shown(&kind)), span, list, &inherited);
        match word {
            "Camera" => self.camera(&kind, params),
            "Film" => self.options.film = Some((kind.into_owned(), params)),
            "PixelFilter" => self.options.filter = Some((kind.into_owned(), params)),
            "Sampler" => self.sampler(&kind, params),
            "Integrator" => self.integrator(&kind, params),
            // How fast it is, not what is seen.
            "Accelerator" => {}
            "Material" => self.material_directive(&kind, params),
            "MakeNamedMaterial" => self.make_named_material(&kind, params),
            "MakeNamedMedium" => self.medium(&kind, params),
            "LightSource" => self.light(&kind, params),
            "AreaLightSource" => self.area_light_source(&kind, params),
            _ => self.shape(&kind, params),
        }
        Ok(())
    }

    pub(super) fn save(&mut self, saved: Saved) {
        if self.stack.len() >= MAX_DEPTH * 16 {
            let (Saved::Attribute(_, span) | Saved::Transform(_, span) | Saved::Object(_, span)) = saved;
            self.error("pbrt::too-deep", &span, "attributes are nested too deeply");
            self.is_broken = true;
            return;
        }
        self.stack.push(saved);
    }

    fn restore(&mut self, word: &str, span: &Span) {
        match (word, self.stack.pop()) {
            ("AttributeEnd", Some(Saved::Attribute(state, _))) => self.state = *state,
            ("TransformEnd", Some(Saved::Transform(saved, _))) => {
                let ([ctm, end_ctm], active) = *saved;
                self.state = State { ctm, end_ctm, active, ..self.state.clone() };
            }
            ("ObjectEnd", Some(Saved::Object(state, _))) => {
                self.state = *state;
                self.object = None;
            }
            (_, saved) => {
                self.error("pbrt::unbalanced", span, format!("{word} ends nothing that was begun"));
                self.stack.extend(saved);
            }
        }
    }

    fn include(&mut self, name: &str, span: &Span) {
        let path = self.out.find(name);
        self.includes += 1;
        let Limits { scene_bytes, included_bytes, pbrt_includes: includes, .. } = self.out.limits;
        let refused = if self.open_files.contains(&path) {
            Some(format!("{} includes itself", path.display()))
        } else if self.includes > includes.len() {
            Some(includes.refusal(format!("more than {includes} files are included")))
        } else if self.open_files.len() > MAX_DEPTH {
            Some(format!("more than {MAX_DEPTH} files are included within one another"))
        } else {
            None
        };
        if let Some(message) = refused {
            self.error("pbrt::include", span, message);
            self.is_broken = true;
            return;
        }
        match Text::read(&path, scene_bytes) {
            Ok(text) if self.included_bytes + text.bytes > included_bytes.len() => {
                let message =
                    included_bytes.refusal(format!("more than {included_bytes} bytes are included"));
                self.error("pbrt::include", span, message);
                self.is_broken = true;
            }
            Ok(mut text) => {
                self.included_bytes += text.bytes;
                let source = self.out.d.sources.add(path.display().to_string(), "");
                self.open_files.push(path);
                self.run(&mut text, source);
                self.out.d.sources.set_text(source, text.text);
                self.open_files.pop();
            }
            Err(reason) => {
                let error = crate::files::error("pbrt::include", span, "included file", &path, &reason);
                self.notes().push(error);
            }
        }
    }

    fn color_space(&mut self, name: &str, span: &Span) {
        match ColorSpace::NAMES.iter().find(|(known, _)| *known == name) {
            Some(&(_, space)) => self.state.color_space = space,
            None => {
                let message = format!("\"{}\" is not a color space that is known", shown(name));
                let note = Diagnostic::warning("pbrt::unknown-value", span, message)
                    .guess(name, ColorSpace::NAMES.map(|(known, _)| known))
                    .consequence("colors are read as before");
                self.notes().push(note);
            }
        }
    }

    /// `Attribute "shape" …`: parameters for all shapes that follow.
    fn attribute(&mut self, s: &mut Scanner<'_>, span: &Span) -> Result<()> {
        let (target, bytes) = s.string()?;
        let list = s.parameters()?;
        let attributes = &mut self.state.attributes;
        let slot = match &*target {
            "shape" => &mut attributes.shape,
            "light" => &mut attributes.light,
            "material" => &mut attributes.material,
            "medium" => &mut attributes.medium,
            "texture" => &mut attributes.texture,
            other => {
                let message = format!("nothing has attributes by the name of \"{}\"", shown(other));
                let span = Span { source: span.source, bytes };
                self.warn("pbrt::unknown-value", &span, message, "they are ignored");
                return Ok(());
            }
        };
        let is_long = list.iter().any(|parameter| parameter.values.len() > MAX_ATTRIBUTES);
        if is_long || slot.len() + list.len() > MAX_ATTRIBUTES {
            self.error(
                "pbrt::too-deep",
                span,
                format!("more than {MAX_ATTRIBUTES} attributes of one kind, or values of one of them"),
            );
            self.is_broken = true;
            return Ok(());
        }
        let slot = Rc::make_mut(slot);
        // The newest go first: they are found first.
        slot.splice(0..0, list.into_iter().map(|parameter| (parameter, span.source)));
        Ok(())
    }
}

fn unknown(word: &str, bytes: std::ops::Range<usize>) -> SyntaxError {
    // A guess is part of the sentence: an error of the syntax has no place for hints.
    let guess =
        Diagnostic::error("", &Span::default(), "").guess(word, support::names(support::DIRECTIVES)).hint;
    let guess = guess.map(|hint| format!("; {hint}")).unwrap_or_default();
    SyntaxError { message: format!("\"{}\" is not a directive of pbrt{guess}", shown(word)), bytes }
}
