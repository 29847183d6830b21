//! sr_python
