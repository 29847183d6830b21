//! A tree of [`Node`]s to a [`SceneDesc`].
//!
//! In: what a front end has read. Out: the description, if nothing was an error. Here names get their meaning;
//! everything that a file asks for and that is not done becomes a diagnostic.

mod analytic;
mod color;
mod emitter;
mod film;
mod group;
mod hair;
mod material;
mod polarization;
mod principled;
mod sensor;
mod settings;
mod shape;
mod sunsky;
mod texture;

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use sr_scene::{Diagnostic, Diagnostics, MaterialId, SceneDesc, Span};

use crate::assembly::Assembly;
use crate::limits::Limits;
use crate::mitsuba::node::{Child, Node};
use crate::mitsuba::plugins;
use crate::mitsuba::props::Props;
use crate::support::Support;
use crate::values::shown;

/// What a tree needs to be understood.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Was it written for Mitsuba 0.5 or 0.6? Then a uniform spectrum on an emitter is white.
    pub legacy: bool,
    /// Where files are looked for, in this order.
    pub directories: Vec<PathBuf>,
    /// An image of latitude and longitude, +Y up, that is put around the scene.
    pub environment: Option<PathBuf>,
    /// How much is taken in.
    pub limits: Limits,
}

/// Lowers a `<scene>` and validates it.
pub fn lower(root: &Node, origin: &Origin, d: &mut Diagnostics) -> Option<SceneDesc> {
    let mut lowering = Lowering::new(origin, d);
    lowering.collect_ids(root);
    lowering.collect_other_names(root);
    lowering.scene(root);
    lowering.out.environment.clone_from(&origin.environment);
    lowering.out.finish(&root.span)
}

/// The description as it grows.
struct Lowering<'a, 'd> {
    origin: &'a Origin,
    out: Assembly<'d>,
    ids: HashMap<&'a str, &'a Node>,
    /// Objects that were lowered already, by the address of their node.
    materials_done: HashMap<usize, MaterialId>,
    textures_done: HashMap<usize, sr_scene::ColorInput>,
    groups_done: HashMap<usize, u32>,
    /// What references mean, by address.
    referred: HashSet<usize>,
    /// Per group, what is placed inside it.
    inner_groups: Vec<Vec<group::Inner>>,
    /// Instances so far, those inside groups counted wherever their group is shown.
    placements: usize,
    /// Objects being lowered: meeting one again is a cycle.
    open: HashSet<usize>,
}

/// Identifies a node for as long as the tree lives.
fn key(node: &Node) -> usize {
    std::ptr::from_ref(node).addr()
}

impl<'a, 'd> Lowering<'a, 'd> {
    fn new(origin: &'a Origin, d: &'d mut Diagnostics) -> Self {
        Self {
            origin,
            out: Assembly::new(origin.directories.clone(), origin.limits, d),
            ids: HashMap::new(),
            materials_done: HashMap::new(),
            textures_done: HashMap::new(),
            groups_done: HashMap::new(),
            referred: HashSet::new(),
            inner_groups: Vec::new(),
            placements: 0,
            open: HashSet::new(),
        }
    }

    fn collect_ids(&mut self, node: &'a Node) {
        for child in &node.children {
            let Child::Node(child) = child else { continue };
            if let Some(id) = child.id.as_deref() {
                self.add_id(id, child, &child.span);
            }
            self.collect_ids(child);
        }
    }

    /// Other names come second: an object's own id goes before them, wherever it is.
    fn collect_other_names(&mut self, root: &'a Node) {
        for child in &root.children {
            let Child::Node(child) = child else { continue };
            for name in &child.other_names {
                self.add_id(&name.id, child, &name.span);
            }
        }
    }

    fn add_id(&mut self, id: &'a str, node: &'a Node, span: &Span) {
        let first = *self.ids.entry(id).or_insert(node);
        if !std::ptr::eq(first, node) {
            let message =
                format!("the id \"{}\" is given to {} and to {}", shown(id), first.title(), node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::duplicate-id", span, message)
                    .consequence("references to it mean the first one"),
            );
        }
    }

    /// The node a child is or refers to.
    fn resolve(&mut self, child: &'a Child) -> Option<&'a Node> {
        let reference = match child {
            Child::Node(node) => return Some(node),
            Child::Reference(reference) => reference,
        };
        let found = self.ids.get(reference.id.as_str()).copied();
        self.referred.extend(found.map(key));
        if found.is_none() {
            let message = format!("there is no object with the id \"{}\"", shown(&reference.id));
            self.out.d.push(
                Diagnostic::error("mitsuba::unresolved-reference", &reference.span, message)
                    .guess(&reference.id, self.ids.keys().copied()),
            );
        }
        found
    }

    /// The nested objects of a class, named or not; references that lead nowhere are reported.
    fn nested(&mut self, props: &mut Props<'a>, class: &str) -> Vec<&'a Node> {
        let taken = props.take_children(|child| match child {
            Child::Node(node) => node.class == class,
            Child::Reference(r) => self.ids.get(r.id.as_str()).is_none_or(|n| n.class == class),
        });
        taken.into_iter().filter_map(|child| self.resolve(child)).collect()
    }

    fn scene(&mut self, root: &'a Node) {
        let mut props = Props::new(root);
        let mut sensors = Vec::new();
        let mut integrators = Vec::new();
        let mut areas = Vec::new();
        for child in props.take_children(|_| true) {
            let node = match child {
                Child::Node(node) => node,
                Child::Reference(reference) => {
                    self.out.d.push(
                        Diagnostic::warning(
                            "mitsuba::unused-child",
                            &reference.span,
                            "a reference that is part of nothing",
                        )
                        .consequence("it is ignored"),
                    );
                    continue;
                }
            };
            match node.class.as_str() {
                "bsdf" => {
                    self.material(node);
                }
                // Used where they are referred to.
                "texture" | "spectrum" | "medium" | "phase" | "volume" | "film" | "sampler" | "rfilter" => {}
                "shape" => self.top_level_shape(node),
                // Of a shape that refers to it: known when all shapes are read.
                "emitter" if node.kind == "area" => areas.push(node),
                "emitter" => self.emitter(node),
                "sensor" => sensors.push(node),
                "integrator" => integrators.push(node),
                _ => {
                    let message = format!("{} has no meaning here", node.title());
                    self.out.d.push(
                        Diagnostic::warning("mitsuba::unused-child", &node.span, message)
                            .consequence("it is ignored"),
                    );
                }
            }
        }
        props.finish(self.out.d);
        for area in areas.into_iter().filter(|area| !self.referred.contains(&key(area))) {
            let message = "an area emitter that no shape refers to";
            self.out.d.push(
                Diagnostic::warning("mitsuba::unused-child", &area.span, message)
                    .consequence("it lights nothing"),
            );
        }
        self.integrators(&integrators);
        self.sensors(&sensors);
        self.report_media(root);
    }

    /// Media that are described at the top: said once, whoever refers to them.
    fn report_media(&mut self, root: &Node) {
        for child in &root.children {
            if let Child::Node(node) = child
                && node.class == "medium"
            {
                self.warn_medium(node);
            }
        }
    }

    fn warn_medium(&mut self, node: &Node) {
        self.out.d.push(
            Diagnostic::warning(
                "mitsuba::unsupported-medium",
                &node.span,
                format!("{} is not supported", node.title()),
            )
            .consequence("its inside is rendered as empty space"),
        );
    }

    /// Reports a plugin that does not exist or is not supported; `consequence` is for those that do not exist.
    fn unknown_plugin(&mut self, node: &Node, consequence: &str) {
        let consequence = match plugins::support(&node.class, &node.kind) {
            Some(Support::Reported(consequence)) => consequence,
            _ => consequence,
        };
        self.unsupported_plugin(node, consequence);
    }

    /// Reports a plugin instead of which something happens that depends on what is in it.
    fn unsupported_plugin(&mut self, node: &Node, consequence: &str) {
        self.out.d.push(
            Diagnostic::warning(
                "mitsuba::unsupported-plugin",
                &node.span,
                format!("{} is not supported", node.title()),
            )
            .guess(&node.kind, plugins::of(&node.class))
            .consequence(consequence),
        );
    }
}
