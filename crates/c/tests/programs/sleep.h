/* Compiled with SLEEP, a program puts its object to sleep after every third sample: it is stored, its memory is wiped, and it
 * is restored. What the program tells is the same. */
#ifndef SLEEP_H
#define SLEEP_H

#ifdef SLEEP
#define SLEEP_BYTES(size) static uint8_t flash[size]
#define SLEEP_NOW(system, object)                                                       \
    do {                                                                                \
        static uint32_t awake;                                                          \
        if (++awake % 3 == 0) {                                                        \
            size_t length;                                                              \
            port_check(kestirim_##system##_snapshot(object, flash, sizeof flash, &length)); \
            for (size_t i = 0; i < sizeof memory / sizeof memory[0]; ++i) {             \
                memory[i] = 0;                                                          \
            }                                                                           \
            port_check(kestirim_##system##_restore(                                     \
                memory, sizeof memory, flash, sizeof flash, &object));                  \
        }                                                                               \
    } while (0)
#else
#define SLEEP_BYTES(size) extern int no_sleep
#define SLEEP_NOW(system, object) (void)object
#endif

#endif
