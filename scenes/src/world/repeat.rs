//! What comes after the end of something that lasts a while.

/// How often it plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Repeat {
    /// Once; it then stays at its end.
    Once,
    /// From the beginning again and again. At the end of a round it stands at its end, and goes on from its beginning.
    #[default]
    Loop,
    /// Forwards and backwards in turn.
    PingPong,
}

impl Repeat {
    /// Where between 0 and `duration` something is that began `elapsed` seconds ago at 0, or at `duration` where `speed` is
    /// negative. Before it began it stands where it will begin. Always finite.
    pub fn phase(self, elapsed: f64, speed: f64, duration: f64) -> f64 {
        let begin = if speed < 0.0 { duration } else { 0.0 };
        let at = begin + elapsed.max(0.0) * speed;
        if !(at.is_finite() && duration > 0.0 && duration.is_finite()) {
            return 0.0;
        }
        match self {
            Repeat::Once => at.clamp(0.0, duration),
            Repeat::Loop => {
                // The moment between two rounds belongs to the one that ends, so that what is timed by the last key shows it.
                let turn = at.rem_euclid(duration);
                if turn == 0.0 && at > 0.0 { duration } else { turn }
            }
            Repeat::PingPong => {
                let turn = at.rem_euclid(2.0 * duration);
                if turn > duration { (2.0 * duration - turn).max(0.0) } else { turn }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_by_hand() {
        let forwards = |repeat: Repeat| [-1.0, 0.0, 1.5, 2.0, 3.0, 4.5].map(|elapsed| repeat.phase(elapsed, 1.0, 2.0));
        assert_eq!(forwards(Repeat::Once), [0.0, 0.0, 1.5, 2.0, 2.0, 2.0]);
        assert_eq!(forwards(Repeat::Loop), [0.0, 0.0, 1.5, 2.0, 1.0, 0.5]);
        assert_eq!(forwards(Repeat::PingPong), [0.0, 0.0, 1.5, 2.0, 1.0, 0.5]);
        let backwards = |repeat: Repeat| [-1.0, 0.0, 0.5, 1.0, 1.5].map(|elapsed| repeat.phase(elapsed, -2.0, 2.0));
        assert_eq!(backwards(Repeat::Once), [2.0, 2.0, 1.0, 0.0, 0.0]);
        assert_eq!(backwards(Repeat::Loop), [2.0, 2.0, 1.0, 0.0, 1.0]);
        assert_eq!(backwards(Repeat::PingPong), [2.0, 2.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn what_has_no_length_or_no_number_stands_at_its_beginning() {
        for repeat in [Repeat::Once, Repeat::Loop, Repeat::PingPong] {
            for (elapsed, speed, duration) in [(3.0, 1.0, 0.0), (1.0, f64::NAN, 2.0), (1e300, 1e300, 2.0), (1.0, 1.0, f64::INFINITY)] {
                assert_eq!(repeat.phase(elapsed, speed, duration), 0.0);
            }
        }
    }
}
