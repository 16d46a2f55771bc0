//! Alpha coverage of mips: a masked surface must not thin out with distance.
//!
//! Filtering alpha and comparing with a fixed cutoff loses thin parts. So each level's alpha is scaled such that the share of texels
//! at or above the cutoff is that of level 0 (I. Castaño, "Computing Alpha Mipmaps", 2010), to within half a texel and
//! ties. Here the scale is exact, since it comes from the sorted alphas rather than from a search.

/// The smallest stored alpha that passes `cutoff`; 256 where nothing can.
pub(super) fn first_passing(cutoff: f32) -> u32 {
    (0..256).find(|alpha| *alpha as f32 / 255.0 >= cutoff).unwrap_or(256)
}

/// The share of RGBA texels that pass.
pub(super) fn coverage(rgba: &[u8], passing: u32) -> f64 {
    let texels = rgba.len() / 4;
    let passed = rgba.chunks_exact(4).filter(|texel| u32::from(texel[3]) >= passing).count();
    if texels == 0 { 0.0 } else { passed as f64 / texels as f64 }
}

/// Stored alphas for the filtered ones (0 to 1), with the coverage asked for.
pub(super) fn keep_coverage(alphas: &[f32], wanted: f64, passing: u32) -> Vec<u8> {
    let mut sorted = alphas.to_vec();
    sorted.sort_unstable_by(|a, b| b.total_cmp(a));
    let count = (wanted * alphas.len() as f64).round() as usize;
    // Equal alphas pass together or not at all: the nearer count wins, more on a tie.
    let threshold = count.checked_sub(1).and_then(|last| sorted.get(last)).copied().filter(|threshold| *threshold > 0.0);
    let threshold = threshold.and_then(|threshold| {
        let above = sorted.partition_point(|alpha| *alpha > threshold);
        let through = sorted.partition_point(|alpha| *alpha >= threshold);
        if through - count <= count - above { Some(threshold) } else { above.checked_sub(1).and_then(|last| sorted.get(last)).copied() }
    });
    let cutoff = passing.min(255) as f32 / 255.0;
    alphas
        .iter()
        .map(|alpha| match threshold {
            // Rounding must not move a texel across the cutoff.
            Some(threshold) if passing < 256 => {
                let scaled = (alpha * (cutoff / threshold) * 255.0).round().clamp(0.0, 255.0) as u32;
                (if *alpha >= threshold { scaled.max(passing) } else { scaled.min(passing.saturating_sub(1)) }) as u8
            }
            _ => (alpha * 255.0).round().clamp(0.0, passing.saturating_sub(1).min(255) as f32) as u8,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_cutoff_is_inclusive() {
        assert_eq!(first_passing(0.0), 0);
        assert_eq!(first_passing(0.5), 128);
        assert_eq!(first_passing(1.0), 255);
        assert_eq!(first_passing(1.5), 256);
        assert_eq!(first_passing(51.0 / 255.0), 51);
    }

    proptest! {
        #[test]
        fn coverage_is_kept_to_half_a_texel(
            distinct in proptest::collection::btree_set(1_u32..1_000_000, 1..200), wanted in 0.0_f64..=1.0, passing in 1_u32..=255,
        ) {
            let alphas: Vec<f32> = distinct.iter().map(|value| *value as f32 / 1_000_000.0).collect();
            let kept = keep_coverage(&alphas, wanted, passing);
            let share = kept.iter().filter(|alpha| u32::from(**alpha) >= passing).count() as f64 / alphas.len() as f64;
            prop_assert!((share - wanted).abs() <= 0.5 / alphas.len() as f64 + 1e-9, "{share} instead of {wanted}");
        }
    }

    #[test]
    fn equal_alphas_pass_together_or_not() {
        assert_eq!(keep_coverage(&[0.5; 4], 1.0, 200), [200; 4]);
        assert!(keep_coverage(&[0.5; 4], 0.25, 200).iter().all(|alpha| *alpha < 200));
        assert!(keep_coverage(&[0.0; 4], 0.5, 128).iter().all(|alpha| *alpha < 128));
        assert!(keep_coverage(&[], 0.5, 128).is_empty());
        assert!(keep_coverage(&[0.9; 3], 0.0, 256).iter().all(|alpha| *alpha > 0));
    }
}
