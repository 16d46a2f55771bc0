// Polygons of light as a point sees them: what of one lies above a plane through the point, and how much light it sends.

#import "shared/math.wgsl"

// A rectangle that three planes have cut.
const MOST_CORNERS: u32 = 7u;

// Corners around an outline, relative to the point.
struct Polygon {
    count: u32,
    corners: array<vec3<f32>, MOST_CORNERS>,
}

// The part of a convex polygon on the side of a plane through the origin that `normal` shows to (Sutherland and Hodgman 1974,
// "Reentrant Polygon Clipping"). It has one corner more at most.
fn clipped(polygon: Polygon, normal: vec3<f32>) -> Polygon {
    var outline = polygon;
    var result: Polygon;
    for (var i = 0u; i < outline.count; i++) {
        let here = outline.corners[i];
        let next = outline.corners[select(i + 1u, 0u, i + 1u == outline.count)];
        let height = dot(here, normal);
        let next_height = dot(next, normal);
        if height > 0.0 && result.count < MOST_CORNERS {
            result.corners[result.count] = here;
            result.count++;
        }
        if (height > 0.0) != (next_height > 0.0) && result.count < MOST_CORNERS {
            result.corners[result.count] = mix(here, next, height / (height - next_height));
            result.count++;
        }
    }
    return result;
}

// The polygon with every corner multiplied by a matrix.
fn transformed(polygon: Polygon, matrix: mat3x3<f32>) -> Polygon {
    var result = polygon;
    for (var i = 0u; i < result.count; i++) {
        result.corners[i] = matrix * result.corners[i];
    }
    return result;
}

// The integral of directions over the solid angle of the polygon, over pi. Its dot product with a normal is the form factor of the
// polygon for a surface whose horizon it does not cross: irradiance over pi L, 1 where it fills the half space. From Lambert's formula
// ("Photometria", 1760), which Baum, Rushmeier and Winget 1989 ("Improving Radiosity Solutions Through the Use of Analytically
// Determined Form-Factors") write as a sum over edges. Positive where the corners run counter-clockwise, seen from the light's back.
fn vector_form_factor(polygon: Polygon) -> vec3<f32> {
    var corners = polygon.corners;
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < polygon.count; i++) {
        let here = normalize(corners[i]);
        let next = normalize(corners[select(i + 1u, 0u, i + 1u == polygon.count)]);
        let across = cross(here, next);
        let sine = length(across);
        // The angle over its sine, which is 1 for corners that fall together.
        if sine > 1.0e-7 {
            sum += across * (atan2(sine, dot(here, next)) / sine);
        } else {
            sum += across;
        }
    }
    return sum / (2.0 * PI);
}
