//! sr_stats
