//! stub
use crate::Export;
use sr_scene::SceneDesc;
pub fn export(_: &SceneDesc, _: &str, _: bool) -> Export { Export { files: vec![], diagnostics: vec![] } }
