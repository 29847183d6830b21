//! sr_geometry
