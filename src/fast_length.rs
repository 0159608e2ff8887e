//! Lengths whose transforms are quick.

/// The least even 2^a 3^b 5^c 7^d that is at least `length`.
pub(crate) fn fast_length(length: usize) -> usize {
    let mut length = length.max(2).next_multiple_of(2);
    while !is_good(length) {
        length += 2;
    }
    length
}

fn is_good(mut length: usize) -> bool {
    for prime in [2, 3, 5, 7] {
        while length.is_multiple_of(prime) {
            length /= prime;
        }
    }
    length == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_lengths_are_even_and_smooth() {
        let cases =
            [(0, 2), (1, 2), (11, 12), (13, 14), (22, 24), (3839, 3840), (2159, 2160), (4321, 4374), (15359, 15360)];
        for (asked, wanted) in cases {
            assert_eq!(fast_length(asked), wanted, "{asked}");
        }
    }
}
