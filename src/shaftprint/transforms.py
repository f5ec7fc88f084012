"""Lengths at which a Fourier transform is quick: products of small primes."""


def largest_quick_length(count: int, fewest: int) -> int:
    """Return the largest product of primes up to 11 from ``fewest`` to ``count``; the count where there is none."""
    return next((length for length in range(count, fewest, -1) if _is_product(length, (2, 3, 5, 7, 11))), count)


def smallest_quick_length(count: int) -> int:
    """Return the smallest product of 2, 3 and 5 from a count on."""
    length = count
    while not _is_product(length, (2, 3, 5)):
        length += 1
    return length


def _is_product(length: int, primes: tuple[int, ...]) -> bool:
    for prime in primes:
        while length % prime == 0:
            length //= prime
    return length == 1
