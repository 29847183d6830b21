//! What each format can say: a table for people, made by exporting one of everything.
