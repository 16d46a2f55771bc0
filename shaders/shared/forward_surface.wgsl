// The surface point of a fragment of a Draw: all of the material's textures, at once.

#import "shared/material_textures.wgsl"
#import "shared/mesh.wgsl"
#import "shared/normals.wgsl"
#import "shared/surface_point.wgsl"

struct DrawnSurface {
    point: SurfacePoint,
    alpha: f32,
}

// Samples and takes differences: call it first, where all invocations come by, and discard afterwards.
fn drawn_surface(fragment: MeshFragment, front_facing: bool) -> DrawnSurface {
    let material = fragment.material;
    let base_color = base_color_at(material, fragment.uv, fragment.color);
    let metallic_roughness = metallic_roughness_at(material, fragment.uv);
    let mapped_normal = tangent_space_normal_at(material, fragment.uv);

    var surface: DrawnSurface;
    surface.alpha = base_color.a;
    surface.point.pixel = fragment.clip_position.xy;
    surface.point.position = view.position + fragment.from_eye;
    surface.point.to_eye = direction_to_view(surface.point.position);
    surface.point.geometric_normal = geometric_normal_of(fragment.from_eye, surface.point.to_eye, fragment.normal);
    surface.point.base_color = base_color.rgb;
    surface.point.metallic = metallic_roughness.x;
    surface.point.roughness = metallic_roughness.y;
    surface.point.dielectric_f0 = dielectric_f0_at(material, fragment.uv);
    surface.point.specular_weight = specular_weight_at(material, fragment.uv);
    surface.point.emission = emission_at(material, fragment.uv);
    surface.point.normal = shading_normal_of(
        fragment.normal,
        fragment.tangent,
        mapped_normal,
        has_flag(material, MATERIAL_HAS_NORMAL_TEXTURE),
        front_facing,
        surface.point.geometric_normal,
        surface.point.to_eye,
    );
    surface.point.unlit = has_flag(material, MATERIAL_UNLIT);
    if surface.point.unlit {
        surface.point.emission = base_color.rgb;
    }
    return surface;
}
