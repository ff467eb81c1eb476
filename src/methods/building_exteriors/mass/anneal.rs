//! Method `paper`.
