//! sr_testing
