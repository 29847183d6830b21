//! pbrt-v4 scene files.
//!
//! In: text. Out: calls of an [`Assembly`]. A file is carried out as it is read, directive by directive.
//!
//! - `syntax`: bytes to words, numbers and parameters. `params`: looking parameters up.
//! - `reader`: one directive after the other, attributes, other files. `transform`, `object`: what else keeps state.
//! - `support`: what there is, and what becomes of it. `color`: values with a color. `texture`, `material`, `light`, `shape`, `camera`, `film`, `options`: what they say.
//!
//! Light transport is RGB here and spectral there: spectra become what the CIE's observer sees, see
//! [`crate::spectra`].

mod camera;
mod color;
mod film;
mod light;
mod material;
mod object;
mod options;
mod params;
mod reader;
mod shape;
mod state;
mod support;
mod syntax;
mod texture;
mod transform;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;

use sr_scene::{Diagnostic, Diagnostics, MaterialId, SceneDesc, Span};

use crate::LoadOptions;
use crate::assembly::Assembly;
use crate::limits::Limits;
use params::Notes;
use state::{Saved, State};
pub use support::table as support_table;
pub use syntax::Text;
use texture::FloatTexture;

/// Is this one of the words that a scene may begin with?
pub fn is_directive(word: &str) -> bool {
    support::names(support::DIRECTIVES).any(|directive| directive == word)
}

/// Loads a scene from text. Files are looked for in `directories`.
pub fn load(
    name: &str,
    mut text: Text,
    directories: Vec<PathBuf>,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    let source = diagnostics.sources.add(name, "");
    let span = Span { source, bytes: 0..text.text.len().min(1) };
    let mut reader = Reader::new(directories, options.limits, diagnostics);
    reader.out.environment.clone_from(&options.environment);
    reader.open_files.push(PathBuf::from(name));
    reader.run(&mut text, source);
    reader.out.d.sources.set_text(source, text.text);
    reader.finish(&span)
}

/// What is known while a scene is read.
struct Reader<'d> {
    out: Assembly<'d>,
    /// Messages that were given already.
    said: HashSet<String>,
    state: State,
    stack: Vec<Saved>,
    coordinate_systems: HashMap<String, [glam::DMat4; 2]>,
    materials: HashMap<String, MaterialId>,
    /// Those that were asked for before they are described, and where.
    awaited: BTreeMap<String, (MaterialId, Span)>,
    /// Shared by all that have none.
    default_material: Option<MaterialId>,
    float_textures: HashMap<String, FloatTexture>,
    color_textures: HashMap<String, texture::ColorTexture>,
    /// Triangles of parts of spheres, disks and cylinders so far.
    swept_triangles: usize,
    /// Objects by name: their group.
    objects: HashMap<String, usize>,
    /// The object that is being described.
    object: Option<usize>,
    options: options::Options,
    /// Files that are being read, the outermost first.
    open_files: Vec<PathBuf>,
    /// How many were included so far.
    includes: usize,
    /// How long they were together.
    included_bytes: usize,
    /// Nothing more is read: a file cannot be understood.
    is_broken: bool,
}

impl<'d> Reader<'d> {
    fn new(directories: Vec<PathBuf>, limits: Limits, diagnostics: &'d mut Diagnostics) -> Self {
        Self {
            out: Assembly::new(directories, limits, diagnostics),
            said: HashSet::new(),
            state: State::default(),
            stack: Vec::new(),
            coordinate_systems: HashMap::new(),
            materials: HashMap::new(),
            awaited: BTreeMap::new(),
            default_material: None,
            float_textures: HashMap::new(),
            color_textures: HashMap::new(),
            swept_triangles: 0,
            objects: HashMap::new(),
            object: None,
            options: options::Options::default(),
            open_files: Vec::new(),
            includes: 0,
            included_bytes: 0,
            is_broken: false,
        }
    }

    /// Where diagnostics go that are said once.
    fn notes(&mut self) -> Notes<'_> {
        Notes { list: self.out.d, said: &mut self.said }
    }

    fn warn(&mut self, code: &'static str, span: &Span, message: impl Into<String>, consequence: &str) {
        self.notes().push(Diagnostic::warning(code, span, message).consequence(consequence));
    }

    /// Says that there is no `what` by this name, with a guess among those that there are.
    fn unresolved<'a>(
        notes: &mut Notes<'_>,
        span: &Span,
        what: String,
        name: &str,
        known: impl Iterator<Item = &'a String>,
        consequence: &str,
    ) {
        // Guessing takes time for each name that there is.
        if notes.is_full() {
            return;
        }
        let note = Diagnostic::warning("pbrt::unresolved-name", span, what)
            .guess(name, known.map(String::as_str))
            .consequence(consequence);
        notes.push(note);
    }

    /// Says why pictures differ from pbrt's, once for each reason.
    fn note(&mut self, code: &'static str, span: &Span, message: &str, consequence: &str) {
        self.notes().push(Diagnostic::note(code, span, message).consequence(consequence));
    }

    fn error(&mut self, code: &'static str, span: &Span, message: impl Into<String>) {
        self.notes().push(Diagnostic::error(code, span, message));
    }

    fn finish(mut self, span: &Span) -> Option<SceneDesc> {
        if !self.is_broken {
            if !self.stack.is_empty() {
                let open = self.stack.len();
                let message = format!("{open} of AttributeBegin, TransformBegin and ObjectBegin have no end");
                self.warn("pbrt::unbalanced", span, message, "they end with the file");
            }
            self.report_awaited();
            self.options_end(span);
        }
        self.out.finish(span)
    }
}
