// Sends samples of an inertial sensor, or ranges, to `host-sim live`: cc send.c -lm && ./a.out 127.0.0.1 5775
#include <arpa/inet.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static uint8_t body[64], line[80];
static size_t length;

static void byte(uint8_t value) { body[length++] = value; }
static void bytes(const void *from, size_t count) { memcpy(body + length, from, count), length += count; } // little-endian
static void varint(uint64_t value) {
    for (; value > 127; value >>= 7) byte((value & 127) | 128);
    byte(value);
}

// Appends the checksum and encodes with COBS: each run without a zero is preceded by its length plus one. Returns the
// length of the frame.
static size_t framed(void) {
    uint32_t crc = ~0u;
    for (size_t i = 0; i < length; i++) {
        crc ^= body[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    bytes(&(uint32_t){~crc}, 4);
    size_t end = 2, code = 1;
    for (size_t i = 0; i <= length; i++) {
        if (i < length && body[i]) line[end++] = body[i];
        else line[code] = end - code, code = end++;
    }
    line[0] = line[end - 1] = 0;
    return end;
}

int main(int count, char **arguments) {
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(atoi(arguments[count - 1]))};
    inet_pton(AF_INET, arguments[1], &to.sin_addr);
    int out = socket(AF_INET, SOCK_DGRAM, 0);
    for (uint16_t number = 0; number < 200; number++) {
        float seconds = number / 100.0f, sample[6] = {0, 0, 9.81f, 0, sinf(seconds), 0}, range = 3 + seconds;
        int is_range = number % 20 == 19;
        length = 0, byte(1), bytes(&number, 2), varint(is_range), varint(number * 10000);
        if (is_range) varint(number % 4), bytes(&range, 4);
        else bytes(sample, 24);
        sendto(out, line, framed(), 0, (struct sockaddr *)&to, sizeof to);
    }
}
