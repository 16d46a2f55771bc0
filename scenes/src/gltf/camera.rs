//! Cameras.
//!
//! Guarantees: near planes, fields of view and extents can be turned into a projection matrix. A camera that can't is an error,
//! since no other view would be the one that was meant.

use std::f32::consts::PI;

use super::json::{Json, clip};
use crate::asset::{Camera, Projection};

/// Checks every camera. A broken one is reported, and `None`.
pub(super) fn read_cameras(root: &Json<'_>) -> Vec<Option<Camera>> {
    let cameras = root.objects("cameras");
    cameras
        .iter()
        .enumerate()
        .map(|(index, json)| Some(Camera { name: json.name_or("camera", index), projection: read_projection(json)? }))
        .collect()
}

fn read_projection(json: &Json<'_>) -> Option<Projection> {
    let kind = json.required("type").and_then(|_| json.text("type"))?;
    match kind {
        "perspective" => read_perspective(&json.required(kind).and_then(|_| json.object(kind))?),
        "orthographic" => read_orthographic(&json.required(kind).and_then(|_| json.object(kind))?),
        other => {
            json.error_at("type", "gltf::camera", format_args!("expected perspective or orthographic, found `{}`", clip(other)));
            None
        }
    }
}

fn read_perspective(json: &Json<'_>) -> Option<Projection> {
    let (yfov, near) = (required_number(json, "yfov"), required_number(json, "znear"));
    let far = if json.has("zfar") { Some(json.number("zfar")?) } else { None };
    let (yfov, near) = (yfov?, near?);
    let mut good = true;
    if !(yfov > 0.0 && yfov < PI) {
        json.error_at("yfov", "gltf::camera", format_args!("expected radians between 0 and pi, found {yfov}"));
        good = false;
    }
    if near <= 0.0 {
        json.error_at("znear", "gltf::camera", format_args!("must be greater than 0, found {near}"));
        good = false;
    }
    if let Some(far) = far
        && far <= near
    {
        json.error_at("zfar", "gltf::camera", format_args!("must be greater than znear ({near}), found {far}"));
        good = false;
    }
    good.then_some(Projection::Perspective { yfov, near, far })
}

fn read_orthographic(json: &Json<'_>) -> Option<Projection> {
    let mags = (required_number(json, "xmag"), required_number(json, "ymag"));
    let planes = (required_number(json, "znear"), required_number(json, "zfar"));
    // Negative extents mirror the view; the format advises against them.
    let ((xmag, ymag), (near, far)) = ((mags.0?.abs(), mags.1?.abs()), (planes.0?, planes.1?));
    if xmag == 0.0 || ymag == 0.0 {
        json.error("gltf::camera", "xmag and ymag must not be 0");
        return None;
    }
    if near < 0.0 || far <= near {
        json.error("gltf::camera", format_args!("expected 0 <= znear < zfar, found {near} and {far}"));
        return None;
    }
    Some(Projection::Orthographic { ymag, xmag, near, far })
}

fn required_number(json: &Json<'_>, key: &str) -> Option<f32> {
    json.required(key)?.as_number()
}
