//! sr_render
