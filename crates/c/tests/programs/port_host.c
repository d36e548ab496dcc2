/* The programs' surroundings on a computer: the stream is standard input, lines go to standard output. */
#include "port.h"

#include <stdio.h>
#include <stdlib.h>

#include "kestirim.h"
#include "tell.h"

int port_read(void *record, size_t bytes)
{
    return fread(record, 1, bytes, stdin) == bytes;
}

void port_tell(const char *key, const void *words, size_t count)
{
    char line[LINE];
    line_of(line, key, words, count);
    fputs(line, stdout);
}

void port_check(int32_t status)
{
    if (status != KESTIRIM_STATUS_OK) {
        fprintf(stderr, "%s\n", kestirim_status_name(status));
        exit(1);
    }
}
