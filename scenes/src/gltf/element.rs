//! Decoding of accessor elements from little endian bytes.
//!
//! Guarantees: no read past the bytes given; what is missing is zero. Integers become floats as glTF 2.0, section 3.11, says.

use super::accessor::Accessor;

/// Type of one component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// By glTF's number, which is OpenGL's.
    pub(super) fn coded(code: u64) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    /// Bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// glTF's name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Component::I8 => "BYTE",
            Component::U8 => "UNSIGNED_BYTE",
            Component::I16 => "SHORT",
            Component::U16 => "UNSIGNED_SHORT",
            Component::U32 => "UNSIGNED_INT",
            Component::F32 => "FLOAT",
        }
    }

    /// An unsigned integer; `None` for other types and for missing bytes.
    pub(super) fn unsigned(self, bytes: &[u8]) -> Option<u32> {
        match self {
            Component::U8 => bytes.first().map(|byte| u32::from(*byte)),
            Component::U16 => bytes.first_chunk().map(|two| u32::from(u16::from_le_bytes(*two))),
            Component::U32 => bytes.first_chunk().map(|four| u32::from_le_bytes(*four)),
            Component::I8 | Component::I16 | Component::F32 => None,
        }
    }

    /// Any component as a float.
    fn float(self, bytes: &[u8], normalized: bool) -> Option<f32> {
        let (value, largest) = match self {
            Component::I8 => (bytes.first().map(|byte| f32::from(*byte as i8)), 127.0),
            Component::U8 => (bytes.first().map(|byte| f32::from(*byte)), 255.0),
            Component::I16 => (bytes.first_chunk().map(|two| f32::from(i16::from_le_bytes(*two))), 32767.0),
            Component::U16 => (bytes.first_chunk().map(|two| f32::from(u16::from_le_bytes(*two))), 65535.0),
            Component::U32 => (bytes.first_chunk().map(|four| u32::from_le_bytes(*four) as f32), 1.0),
            Component::F32 => return bytes.first_chunk().map(|four| f32::from_le_bytes(*four)),
        };
        // The most negative integer lies below -1.
        value.map(|value| if normalized { (value / largest).max(-1.0) } else { value })
    }
}

/// Components of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

impl Kind {
    /// By glTF's name.
    pub(super) fn named(name: &str) -> Option<Kind> {
        [Kind::Scalar, Kind::Vec2, Kind::Vec3, Kind::Vec4, Kind::Mat2, Kind::Mat3, Kind::Mat4].into_iter().find(|kind| kind.name() == name)
    }

    /// glTF's name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::Scalar => "SCALAR",
            Kind::Vec2 => "VEC2",
            Kind::Vec3 => "VEC3",
            Kind::Vec4 => "VEC4",
            Kind::Mat2 => "MAT2",
            Kind::Mat3 => "MAT3",
            Kind::Mat4 => "MAT4",
        }
    }

    /// How many components.
    pub(super) fn components(self) -> usize {
        match self {
            Kind::Scalar => 1,
            Kind::Vec2 => 2,
            Kind::Vec3 => 3,
            Kind::Vec4 | Kind::Mat2 => 4,
            Kind::Mat3 => 9,
            Kind::Mat4 => 16,
        }
    }

    /// Bytes of an element; the columns of a matrix start at multiples of four.
    pub(super) fn size(self, component: Component) -> usize {
        let columns = match self {
            Kind::Mat2 => 2,
            Kind::Mat3 => 3,
            Kind::Mat4 => 4,
            _ => return self.components() * component.size(),
        };
        columns * (columns * component.size()).next_multiple_of(4)
    }
}

impl Accessor<'_> {
    /// The first `N` components of an element as floats; zero where it has fewer. Not for small-integer matrices, whose columns are padded.
    pub(super) fn floats<const N: usize>(&self, index: usize) -> [f32; N] {
        let mut out = [0.0; N];
        if let Some(bytes) = self.element(index) {
            for (slot, bytes) in out.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
                *slot = self.component.float(bytes, self.normalized).unwrap_or(0.0);
            }
        }
        out
    }

    /// The first `N` components of an element as unsigned integers.
    pub(super) fn integers<const N: usize>(&self, index: usize) -> [u32; N] {
        let mut out = [0; N];
        if let Some(bytes) = self.element(index) {
            for (slot, bytes) in out.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
                *slot = self.component.unsigned(bytes).unwrap_or(0);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_integers_reach_both_ends() {
        assert_eq!(Component::I8.float(&[0x80], true), Some(-1.0));
        assert_eq!(Component::I8.float(&[0x81], true), Some(-1.0));
        assert_eq!(Component::U8.float(&[255], true), Some(1.0));
        assert_eq!(Component::I16.float(&[0xFF, 0x7F], true), Some(1.0));
        assert_eq!(Component::U16.float(&[0xFF, 0xFF], false), Some(65535.0));
        assert_eq!(Component::F32.float(&[0, 0], false), None);
    }

    #[test]
    fn matrix_columns_are_padded() {
        assert_eq!(Kind::Mat2.size(Component::U8), 8);
        assert_eq!(Kind::Mat3.size(Component::I16), 24);
        assert_eq!(Kind::Mat4.size(Component::F32), 64);
    }
}
