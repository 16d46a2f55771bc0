// Colours: linear Rec.709 throughout.

// Relative luminance (ITU-R BT.709).
fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3<f32>(0.2126, 0.7152, 0.0722));
}
