//! Same scene, same binary: same bits.
