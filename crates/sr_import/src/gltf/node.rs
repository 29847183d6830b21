//! Nodes: what stands where. A mesh that several nodes show is kept once.

use std::collections::{HashMap, HashSet};

use glam::{Affine3A, DMat4, DQuat, DVec3};
use sr_scene::{Geometry, GroupDesc, InstanceDesc, MeshDesc, ShapeDesc, Span};

use super::document::Document;
use super::geometry::{Bend, Part};
use super::json::Value;
use crate::assembly::MeshSource;
use crate::mesh::{Convention, Placement};

/// A mesh at a place.
struct Shown<'v> {
    mesh: usize,
    desc: &'v Value,
    world: DMat4,
    node: usize,
    node_desc: &'v Value,
}

impl<'v> Document<'v, '_> {
    /// Puts everything of the scene that the file chooses in its place.
    pub fn scene(&mut self) {
        self.load_images();
        if let Some(animations) = self.root.get("animations").filter(|a| !a.list().is_empty()) {
            let message = "animations are not played";
            self.warn_once("gltf::animation", &animations.span, message, "everything stands as it rests");
        }
        let mut shown = Vec::new();
        let mut cameras = Vec::new();
        let worlds = self.walk(&mut shown, &mut cameras);
        if let [(first, world), others @ ..] = &cameras[..] {
            self.camera(first, world);
            if let [(second, _), ..] = others {
                let message = format!("the scene has {} cameras", cameras.len());
                self.warn("gltf::cameras", &second.span, message, "the first is used");
            }
        }
        let mut users: HashMap<usize, usize> = HashMap::new();
        shown.iter().for_each(|s| *users.entry(s.mesh).or_default() += 1);
        let mut groups: HashMap<usize, Option<u32>> = HashMap::new();
        // Those of a mesh that several lights show are counted each time.
        let mut placed = 0;
        for s in shown {
            let skin = s.node_desc.get("skin").and_then(|skin| self.item("skins", skin));
            let weights = s.node_desc.get("weights");
            let joints = skin.map(|skin| self.joints(skin, &worlds));
            let bent = joints.is_some() || weights.is_some();
            let bend = Bend { node: bent.then_some(s.node), weights, joints: joints.as_deref() };
            let parts = self.parts(s.mesh, s.desc, bend);
            // A skinned mesh is where its joints are.
            let world = if joints.is_some() { DMat4::IDENTITY } else { s.world };
            let (dark, lit): (Vec<Part>, Vec<Part>) =
                parts.into_iter().partition(|part| part.surface.emission.is_none());
            let shared = !bent && users[&s.mesh] > 1;
            let alone = if shared { lit } else { dark.iter().cloned().chain(lit).collect() };
            for part in alone {
                placed += part.mesh.triangles.len();
                let limit = self.out.limits.gltf_triangles;
                if placed > limit.len() {
                    let message = limit.refusal(format!("more than {limit} triangles"));
                    self.error("gltf::too-large", &part.span, message);
                    return;
                }
                let (shape, mesh) = shape(&part, world);
                self.out.add_shape(shape, Some(mesh));
            }
            if shared {
                let group = *groups.entry(s.mesh).or_insert_with(|| self.group(&dark));
                self.instance(group, &world, &s.node_desc.span);
            }
        }
    }

    fn group(&mut self, parts: &[Part]) -> Option<u32> {
        if parts.is_empty() {
            return None;
        }
        let group = self.out.groups.len();
        self.out.groups.push(GroupDesc { shapes: Vec::new() });
        for part in parts {
            let (shape, mesh) = shape(part, DMat4::IDENTITY);
            self.out.add_shape_to_group(group, shape, Some(mesh));
        }
        Some(group as u32)
    }

    fn instance(&mut self, group: Option<u32>, world: &DMat4, span: &Span) {
        let Some(group) = group else { return };
        let world_from_group = Affine3A::from_mat4(world.as_mat4());
        if !world_from_group.inverse().is_finite() {
            self.warn("gltf::flat-node", span, "the node flattens its mesh", "it is left out");
            return;
        }
        self.out.instances.push(InstanceDesc { group, world_from_group, span: span.clone() });
    }

    /// Goes down from the roots; where each node is.
    fn walk(
        &mut self,
        shown: &mut Vec<Shown<'v>>,
        cameras: &mut Vec<(&'v Value, DMat4)>,
    ) -> HashMap<usize, DMat4> {
        let mut worlds = HashMap::new();
        let mut seen = HashSet::new();
        let mut open: Vec<(&Value, DMat4)> = Vec::new();
        let roots = self.roots();
        open.extend(roots.iter().rev().map(|root| (root, DMat4::IDENTITY)));
        while let Some((reference, parent)) = open.pop() {
            let (Some(node), Some(index)) = (self.item("nodes", reference), reference.index()) else {
                continue;
            };
            if !seen.insert(index) {
                let message = format!("node {index} hangs in two places, or in itself");
                self.warn("gltf::node-cycle", &reference.span, message, "the first is kept");
                continue;
            }
            let world = parent * self.local(node);
            worlds.insert(index, world);
            let children = node.get("children").map_or(&[][..], Value::list);
            open.extend(children.iter().rev().map(|child| (child, world)));
            if let Some(mesh) = node.get("mesh")
                && let (Some(desc), Some(mesh)) = (self.item("meshes", mesh), mesh.index())
            {
                let places = self.places(node, world);
                shown.extend(places.into_iter().map(|world| Shown {
                    mesh,
                    desc,
                    world,
                    node: index,
                    node_desc: node,
                }));
            }
            if let Some(camera) = node.get("camera").and_then(|camera| self.item("cameras", camera)) {
                cameras.push((camera, world));
            }
            if let Some(light) = node.extension("KHR_lights_punctual").and_then(|light| light.get("light")) {
                let lights = self.root.extension("KHR_lights_punctual").and_then(|all| all.get("lights"));
                let found = light.index().and_then(|i| lights.map_or(&[][..], Value::list).get(i));
                match found {
                    Some(found) => self.light(found, &world),
                    None => self.error("gltf::bad-index", &light.span, "this is none of the file's lights"),
                }
            }
        }
        worlds
    }

    /// The nodes that the scene begins with: those of the chosen one, or all that are nobody's children.
    fn roots(&mut self) -> Vec<Value> {
        let scenes = self.root.get("scenes").map_or(&[][..], Value::list);
        let chosen = match self.root.get("scene") {
            Some(index) => self.item("scenes", index),
            None => scenes.first(),
        };
        if let (Some(chosen), true) = (chosen, scenes.len() > 1) {
            let message = format!("the file has {} scenes", scenes.len());
            self.warn("gltf::scenes", &chosen.span, message, "this one is shown");
        }
        if let Some(chosen) = chosen {
            self.image_based_light(chosen);
            return chosen.get("nodes").map_or(Vec::new(), |nodes| nodes.list().to_vec());
        }
        let nodes = self.root.get("nodes").map_or(&[][..], Value::list);
        let children: HashSet<usize> = nodes
            .iter()
            .flat_map(|node| node.get("children").map_or(&[][..], Value::list))
            .filter_map(Value::index)
            .collect();
        let root = |(at, node): (usize, &Value)| {
            let kind = super::json::Kind::Number(at as f64);
            (!children.contains(&at)).then(|| Value { kind, span: node.span.clone() })
        };
        nodes.iter().enumerate().filter_map(root).collect()
    }

    fn local(&mut self, node: &Value) -> DMat4 {
        if node.get("matrix").is_some() {
            return DMat4::from_cols_array(&self.numbers(node, "matrix", DMat4::IDENTITY.to_cols_array()));
        }
        let translation = DVec3::from(self.numbers(node, "translation", [0.0; 3]));
        let rotation = DQuat::from_array(self.numbers(node, "rotation", [0.0, 0.0, 0.0, 1.0]));
        let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
        let scale = DVec3::from(self.numbers(node, "scale", [1.0; 3]));
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }

    /// Where a node shows its mesh: once, or by EXT_mesh_gpu_instancing as often as it says.
    fn places(&mut self, node: &Value, world: DMat4) -> Vec<DMat4> {
        let instancing = node.extension("EXT_mesh_gpu_instancing").and_then(|e| e.get("attributes"));
        let Some(attributes) = instancing else { return vec![world] };
        let mut rows = |name, width| attributes.get(name).and_then(|index| self.rows(index, &[width]));
        let (translation, rotation, scale) = (rows("TRANSLATION", 3), rows("ROTATION", 4), rows("SCALE", 3));
        let count =
            [&translation, &rotation, &scale].into_iter().flatten().map(|r| r.len()).max().unwrap_or(0);
        let row3 = |rows: &Option<super::accessor::Rows>, at, default| {
            let row = rows.as_ref().and_then(|rows| rows.iter().nth(at));
            row.map_or(default, DVec3::from_slice)
        };
        (0..count)
            .map(|at| {
                let turned = rotation.as_ref().and_then(|rows| rows.iter().nth(at)).map(DQuat::from_slice);
                let turned =
                    turned.filter(|q| q.length_squared() > 0.0).map_or(DQuat::IDENTITY, |q| q.normalize());
                let (scale, moved) = (row3(&scale, at, DVec3::ONE), row3(&translation, at, DVec3::ZERO));
                world * DMat4::from_scale_rotation_translation(scale, turned, moved)
            })
            .collect()
    }
}

/// A primitive as a shape, and its mesh to be placed.
fn shape(part: &Part, to_world: DMat4) -> (ShapeDesc, (MeshSource, Placement)) {
    let placement = Placement {
        to_world,
        face_normals: false,
        flip_normals: false,
        max_smooth_angle: None,
        flat: false,
        subdivision: None,
        convention: Convention::Flat,
        colors: true,
    };
    let shape = ShapeDesc {
        geometry: Geometry::Mesh(MeshDesc::default().into()),
        material: part.surface.material,
        emission: part.surface.emission,
        span: part.span.clone(),
    };
    (shape, (MeshSource::Memory(part.mesh.clone()), placement))
}
