//! Building exteriors (Fan and Wonka 2016).
