/* What the programs need of their surroundings: port_host.c on a computer, port_bare.c on a bare machine. */
#ifndef PORT_H
#define PORT_H

#include <stddef.h>
#include <stdint.h>

/* Reads the next record of the stream; 1 if it is whole, 0 at the end. */
int port_read(void *record, size_t bytes);

/* Tells a line: the key, and so many 32-bit words in hexadecimal. */
void port_tell(const char *key, const void *words, size_t count);

/* Ends the program if a call failed. */
void port_check(int32_t status);

#endif
