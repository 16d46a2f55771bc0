//! Why each pass ran or did not.
