// How much of a rectangle a surface sees, from depth as its middle sees it (after Fernando 2005, "Percentage-Closer Soft Shadows"; where
// on the light an occluder lies is asked as Guennebaud, Barthe and Paulin 2006 do, "Real-time Soft Shadow Mapping by Backprojection").
//
// The ray from a surface to a point of the rectangle, `aside` of its middle, runs before the map along the directions
// `away + s aside`, where `away` is the way from the middle to the surface and s grows from 0 at the surface. What a texel holds has an s
// of its own, which follows from its distance. A ray runs behind what has a greater one than the place where it is found, and meets the
// surface where both are the same. First a search finds which s there are, then rays to points of the rectangle are followed through those.
//
// Accepted: what the middle does not see, since something else is before it, blocks nothing; points count alike, however much light comes
// from each.

#import "shared/shadow_disc.wgsl"
#import "shared/shadow_rectangle.wgsl"
#import "shared/surface_point.wgsl"

// Texels that the search looks at, rays to points of the rectangle, and how many steps each of these takes.
const SEARCHED: u32 = 96u;
const RAYS: u32 = 16u;
const STEPS: u32 = 5u;
// How often the place is halved where a ray comes out from behind something.
const HALVINGS: u32 = 5u;
// What the search found, and so much more.
const MARGIN: f32 = 1.2;
// A surface does not come nearer by more than this factor from one place to the next.
const EVENLY: f32 = 1.5;
// Nothing nearer to the rectangle than this part of the way blocks a part of it.
const LEAST_WAY: f32 = 0.04;
// The R2 sequence: see shaders/supersample/jitter.wgsl.
const POINT_STEP: vec2<f32> = vec2<f32>(0.7548776662466927, 0.5698402909980532);

// A surface as it is seen from the middle of a rectangle, metres.
struct SoftReceiver {
    row: u32,
    // From the middle.
    away: vec3<f32>,
    normal: vec3<f32>,
    // Towards the side of the rectangle's plane where the surface is, and how far it is from the plane.
    front: vec3<f32>,
    height: f32,
    // What is not so far above the surface is the surface.
    bias: f32,
}

// `sharp` is how much of the middle is seen.
fn soft_rectangle_shadow(index: u32, point: SurfacePoint, sharp: f32) -> f32 {
    let size = f32(textureDimensions(rectangle_maps).x);
    var receiver: SoftReceiver;
    receiver.row = index;
    receiver.away = point.position - rectangle_lights[index].position;
    receiver.normal = point.geometric_normal;
    let height = rectangle_height(index, receiver.away);
    receiver.front = sign(height) * normalize(cross(rectangle_lights[index].half_width, rectangle_lights[index].half_height));
    receiver.height = abs(height);
    let distance = largest(abs(receiver.away));
    let texel_size = 2.0 * distance / size;
    receiver.bias = BIAS * texel_size + square(distance) / rectangle_lights[index].near * exp2(-22.0);

    // From where rays leave the texel in which the surface is.
    let least = 1.5 * texel_size / rectangle_lights[index].radius;
    let most = max(2.0 * least, 1.0 / LEAST_WAY - 1.0);
    let noise = interleaved_gradient_noise(point.pixel);
    var first = most;
    var last = 0.0;
    for (var i = 0u; i < SEARCHED; i++) {
        let along = least * pow(most / least, (f32(i) + noise) / f32(SEARCHED));
        let found = along_ray(receiver, along * aside_at(index, i, noise));
        if found.blocks {
            first = min(first, found.along);
            last = max(last, found.along);
        }
    }
    if last == 0.0 {
        return sharp;
    }
    first = max(first / MARGIN, least);
    last = max(min(last * MARGIN, most), first);
    let ratio = pow(last / first, 1.0 / f32(STEPS));
    var seen = 0.0;
    for (var i = 0u; i < RAYS; i++) {
        seen += select(1.0, 0.0, is_blocked(receiver, aside_at(index, i, noise), first, ratio, 4.0 * least));
    }
    return seen / f32(RAYS);
}

// Follows a ray. Where something is nearer to the rectangle than the ray, the ray runs behind it; where it comes out again, it
// has either met its surface, or left what it hides. The first is where the map goes on evenly, but for `slack`.
fn is_blocked(receiver: SoftReceiver, aside: vec3<f32>, first: f32, ratio: f32, slack: f32) -> bool {
    var hidden_at = 0.0;
    var before = 0.0;
    var along = first;
    for (var step = 0u; step <= STEPS; step++) {
        var after = along_ray(receiver, along * aside).along;
        if after > along {
            hidden_at = along;
            before = after;
        } else if before > 0.0 {
            var out_at = along;
            for (var i = 0u; i < HALVINGS; i++) {
                let middle = sqrt(hidden_at * out_at);
                let found = along_ray(receiver, middle * aside).along;
                if found > middle {
                    hidden_at = middle;
                    before = found;
                } else {
                    out_at = middle;
                    after = found;
                }
            }
            if before <= EVENLY * after + slack {
                return true;
            }
            before = 0.0;
        }
        along *= ratio;
    }
    return false;
}

// A point of the rectangle, from its middle.
fn aside_at(index: u32, number: u32, noise: f32) -> vec3<f32> {
    let at = 2.0 * fract(vec2<f32>(noise, fract(noise * 61.0)) + f32(number) * POINT_STEP) - 1.0;
    return at.x * rectangle_lights[index].half_width + at.y * rectangle_lights[index].half_height;
}

struct Found {
    // Its s; 0 where there is nothing between the surface and the rectangle's plane.
    along: f32,
    // Whether it is before some point of the rectangle.
    blocks: bool,
}

// What the middle sees `shift` beside the surface.
fn along_ray(receiver: SoftReceiver, shift: vec3<f32>) -> Found {
    let size = f32(textureDimensions(rectangle_maps).x);
    let direction = receiver.away + shift;
    let face = cube_face(direction);
    let there = into_cube_face(face, direction);
    let place = (there.xy / there.z * 0.5 + 0.5) * size + map_shift();
    let texel = clamp(floor(place), vec2<f32>(0.0), vec2<f32>(size - 1.0));
    let depth = textureLoad(rectangle_maps, vec2<i32>(texel), receiver.row * 6u + face, 0);
    let ray = cube_direction(face, (texel + 0.5 - map_shift()) * (2.0 / size) - 1.0);
    let occluder = ray * rectangle_distance(receiver.row, depth);
    let height = dot(receiver.front, occluder);
    let above = dot(receiver.normal, occluder - receiver.away);
    var found: Found;
    if depth >= 1.0 || above <= receiver.bias || height >= receiver.height
        || height <= LEAST_HEIGHT * rectangle_lights[receiver.row].radius {
        return found;
    }
    found.along = (receiver.height - height) / height;
    // Where the ray from the surface through it meets the rectangle's plane.
    let there_on_plane = receiver.away + (occluder - receiver.away) * (receiver.height / (receiver.height - height));
    let width = rectangle_lights[receiver.row].half_width;
    let up = rectangle_lights[receiver.row].half_height;
    let across = cross(width, up);
    let at = vec2<f32>(dot(cross(there_on_plane, up), across), dot(cross(width, there_on_plane), across)) / dot(across, across);
    found.blocks = all(abs(at) <= vec2<f32>(1.0));
    return found;
}
