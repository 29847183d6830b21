//! sr_import
