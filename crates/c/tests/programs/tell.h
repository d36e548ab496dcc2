/* The text of a line, for both ports: "key=0123abcd …\n", zero-terminated. */
#ifndef TELL_H
#define TELL_H

#include <stddef.h>
#include <stdint.h>

enum { LINE = 256 };

static inline void line_of(char *line, const char *key, const void *words, size_t count)
{
    size_t at = 0;
    for (; *key != '\0' && at < 32; ++key) {
        line[at++] = *key;
    }
    line[at++] = '=';
    for (size_t i = 0; i < count && at + 11 < LINE; ++i) {
        uint32_t word;
        __builtin_memcpy(&word, (const unsigned char *)words + 4 * i, sizeof word);
        if (i > 0) {
            line[at++] = ' ';
        }
        for (int shift = 28; shift >= 0; shift -= 4) {
            line[at++] = "0123456789abcdef"[(word >> shift) & 15u];
        }
    }
    line[at++] = '\n';
    line[at] = '\0';
}

#endif
