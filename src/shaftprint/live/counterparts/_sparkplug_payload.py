"""Payloads of Sparkplug B, read and written: the protocol buffer of its specification, and the types that blocks need.

The package of the specification's own project is old and has no licence; what is used of the format is two messages.
Fields that are not known are skipped, as protocol buffers want it; what is cut or contradicts itself is refused.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray

Value: TypeAlias = int | float | bool | str | FloatArray | None

INT64: Final = 4
UINT64: Final = 8
DOUBLE: Final = 10
BOOLEAN: Final = 11
STRING: Final = 12
FLOAT_ARRAY: Final = 30
DOUBLE_ARRAY: Final = 31
"""Types of values, as the specification numbers them."""
_SIGNED_BITS: Final = {1: 8, 2: 16, 3: 32, INT64: 64}
_ARRAYS: Final = {
    22: "<i1",
    23: "<i2",
    24: "<i4",
    25: "<i8",
    26: "<u1",
    27: "<u2",
    28: "<u4",
    29: "<u8",
    FLOAT_ARRAY: "<f4",
    DOUBLE_ARRAY: "<f8",
}
_MOST_METRICS: Final = 10_000
_VARINT, _FIXED_64, _BYTES, _FIXED_32 = 0, 1, 2, 5
# fields of a payload, and of a metric
_TIMESTAMP, _METRICS, _SEQ = 1, 2, 3
_NAME, _ALIAS, _WHEN, _TYPE, _IS_NULL = 1, 2, 3, 4, 7
_INT, _LONG, _FLOAT, _DOUBLE, _BOOLEAN, _STRING, _BYTES_VALUE = range(10, 17)
_WIRES: Final = {
    _INT: _VARINT,
    _LONG: _VARINT,
    _BOOLEAN: _VARINT,
    _FLOAT: _FIXED_32,
    _DOUBLE: _FIXED_64,
    _STRING: _BYTES,
    _BYTES_VALUE: _BYTES,
}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Metric:
    """One value with its name or, where a birth has said which that is, with its number."""

    name: str = ""
    """Name; empty where only the number stands."""
    alias: int | None = None
    """Number that stands for the name after a birth."""
    kind: int = 0
    """Type of the value; 0 where it is not stated."""
    value: Value = None
    """Value; None where it is null or of a type that is not known here."""
    time_ms: int | None = None
    """Time since 1970 [ms]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Payload:
    """What one message holds."""

    metrics: tuple[Metric, ...] = ()
    """Its values."""
    seq: int | None = None
    """Its number, from 0 to 255; none of a death."""
    time_ms: int | None = None
    """Time since 1970 [ms]."""

    def value(self, name: str) -> Value:
        """Return the value of a name, None where it is not there."""
        return next((metric.value for metric in self.metrics if metric.name == name), None)


def encoded(payload: Payload) -> bytes:
    """Return a payload as bytes."""
    out = bytearray()
    if payload.time_ms is not None:
        out += _varint_field(_TIMESTAMP, payload.time_ms)
    for metric in payload.metrics:
        out += _bytes_field(_METRICS, _encoded_metric(metric))
    if payload.seq is not None:
        out += _varint_field(_SEQ, payload.seq)
    return bytes(out)


def decoded(content: bytes) -> Payload:
    """Return what bytes say.

    Raises ValueError, in a sentence, if they are no payload.
    """
    metrics: list[Metric] = []
    seq = time_ms = None
    for number, wire, value in _fields(content):
        if number == _METRICS and wire == _BYTES and isinstance(value, bytes):
            if len(metrics) == _MOST_METRICS:
                raise ValueError(f"expected at most {_MOST_METRICS} metrics in a payload of Sparkplug, found more.")
            metrics.append(_metric(value))
        elif number == _SEQ and wire == _VARINT and isinstance(value, int):
            seq = value
        elif number == _TIMESTAMP and wire == _VARINT and isinstance(value, int):
            time_ms = value
    return Payload(metrics=tuple(metrics), seq=seq, time_ms=time_ms)


def _encoded_metric(metric: Metric) -> bytes:
    out = bytearray()
    if metric.name:
        out += _bytes_field(_NAME, metric.name.encode())
    if metric.alias is not None:
        out += _varint_field(_ALIAS, metric.alias)
    if metric.time_ms is not None:
        out += _varint_field(_WHEN, metric.time_ms)
    out += _varint_field(_TYPE, metric.kind)
    value = metric.value
    if value is None:
        return bytes(out + _varint_field(_IS_NULL, 1))
    if isinstance(value, np.ndarray):
        return bytes(out + _bytes_field(_BYTES_VALUE, value.astype(_ARRAYS[metric.kind]).tobytes()))
    if isinstance(value, str):
        return bytes(out + _bytes_field(_STRING, value.encode()))
    if metric.kind == BOOLEAN:
        return bytes(out + _varint_field(_BOOLEAN, int(value)))
    if metric.kind == DOUBLE:
        return bytes(out + _varint(_DOUBLE << 3 | _FIXED_64) + struct.pack("<d", value))
    return bytes(out + _varint_field(_LONG, int(value) & 0xFFFF_FFFF_FFFF_FFFF))


def _metric(content: bytes) -> Metric:
    name, alias, time_ms, kind, is_null = "", None, None, 0, False
    stored: tuple[int, int | bytes] | None = None
    for number, wire, value in _fields(content):
        if number == _NAME and isinstance(value, bytes):
            name = _text(value)
        elif wire == _VARINT and isinstance(value, int) and number in (_ALIAS, _WHEN, _TYPE, _IS_NULL):
            if number == _ALIAS:
                alias = value
            elif number == _WHEN:
                time_ms = value
            elif number == _TYPE:
                kind = value
            else:
                is_null = bool(value)
        elif _WIRES.get(number) == wire:
            stored = number, value
    return Metric(
        name=name,
        alias=alias,
        kind=kind,
        time_ms=time_ms,
        value=None if stored is None or is_null else _value(kind, *stored),
    )


def _value(kind: int, field: int, stored: int | bytes) -> Value:
    if isinstance(stored, int):
        if field == _BOOLEAN:
            return bool(stored)
        bits = _SIGNED_BITS.get(kind)
        if bits is None:
            return stored
        # small numbers with a sign come as 32 bits, or as many as they have
        stored &= (1 << bits) - 1
        return stored - (1 << bits) if stored >> (bits - 1) else stored
    if field == _FLOAT:
        return float(struct.unpack("<f", stored)[0])
    if field == _DOUBLE:
        return float(struct.unpack("<d", stored)[0])
    if field == _STRING:
        return _text(stored)
    if kind not in _ARRAYS:
        return None
    dtype = np.dtype(_ARRAYS[kind])
    if len(stored) % dtype.itemsize:
        raise ValueError(f"expected an array of numbers of {dtype.itemsize} bytes, found {len(stored)} bytes.")
    return np.frombuffer(stored, dtype).astype(np.float64)


def _text(content: bytes) -> str:
    return content.decode("utf-8", errors="replace")


def _fields(content: bytes) -> Iterator[tuple[int, int, int | bytes]]:
    """Yield number, kind on the wire, and value of each field."""
    at = 0
    while at < len(content):
        key, at = _read_varint(content, at)
        number, wire = key >> 3, key & 7
        if wire == _VARINT:
            value, at = _read_varint(content, at)
            yield number, wire, value
            continue
        if wire == _BYTES:
            length, at = _read_varint(content, at)
        elif wire in (_FIXED_64, _FIXED_32):
            length = 8 if wire == _FIXED_64 else 4
        else:
            raise ValueError(f"expected a payload of Sparkplug, found a field of the unknown kind {wire}.")
        if at + length > len(content):
            raise ValueError(f"expected {length} bytes more in a payload of Sparkplug, found {len(content) - at}.")
        yield number, wire, content[at : at + length]
        at += length


def _read_varint(content: bytes, at: int) -> tuple[int, int]:
    value = 0
    for number, byte in enumerate(content[at : at + 10]):
        value |= (byte & 0x7F) << 7 * number
        if byte < 0x80:
            return value & 0xFFFF_FFFF_FFFF_FFFF, at + number + 1
    raise ValueError("expected a payload of Sparkplug, found a number that does not end.")


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _varint_field(number: int, value: int) -> bytes:
    return _varint(number << 3 | _VARINT) + _varint(value)


def _bytes_field(number: int, content: bytes) -> bytes:
    return _varint(number << 3 | _BYTES) + _varint(len(content)) + content
