"""Sends samples of an inertial sensor, or ranges, to `host-sim live`: python3 send.py 127.0.0.1 5775"""
import math, socket, struct, sys, zlib


def varint(number):
    """Encodes a number with seven bits per byte, the lowest first."""
    digits = bytearray()
    while number > 127:
        digits.append(number & 127 | 128)
        number >>= 7
    return bytes(digits) + bytes([number])


def imu(time_us, force, rate):
    return varint(0) + varint(time_us) + struct.pack("<6f", *force, *rate)


def anchors_range(time_us, anchor, metres):
    return varint(1) + varint(time_us) + varint(anchor) + struct.pack("<f", metres)


def frame(number, message):
    body = b"\x01" + struct.pack("<H", number % 65536) + message
    body += struct.pack("<I", zlib.crc32(body))
    # COBS: each run without a zero is preceded by its length plus one.
    return b"\0" + b"".join(bytes([len(part) + 1]) + part for part in body.split(b"\0")) + b"\0"


line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for number in range(200):
    seconds = number / 100
    message = imu(number * 10_000, (0.0, 0.0, 9.81), (0.0, math.sin(seconds), 0.0))
    if number % 20 == 19:
        message = anchors_range(number * 10_000, number % 4, 3.0 + seconds)
    line.sendto(frame(number, message), (sys.argv[1], int(sys.argv[2])))
