/* The programs' surroundings on a bare machine that an emulator plays: semihosting, and how the processor starts. The
   stream is the file `stream.bin`; lines go to the semihosting console. */
#include "port.h"

#include "kestirim.h"
#include "tell.h"

enum { SYS_OPEN = 0x01, SYS_WRITE0 = 0x04, SYS_READ = 0x06, SYS_EXIT = 0x18 };
enum { STOPPED_APPLICATION_EXIT = 0x20026, STOPPED_RUN_TIME_ERROR = 0x20023 };

static uintptr_t host(uintptr_t operation, uintptr_t argument)
{
#if defined(__arm__)
    register uintptr_t r0 __asm__("r0") = operation;
    register uintptr_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
#else
    register uintptr_t a0 __asm__("a0") = operation;
    register uintptr_t a1 __asm__("a1") = argument;
    __asm__ volatile(".option push\n.option norvc\n.balign 16\n"
                     "slli x0, x0, 0x1f\nebreak\nsrai x0, x0, 7\n.option pop"
                     : "+r"(a0) : "r"(a1) : "memory");
    return a0;
#endif
}

int port_read(void *record, size_t bytes)
{
    static uintptr_t file = (uintptr_t)-1;
    if (file == (uintptr_t)-1) {
        static const char name[] = "stream.bin";
        const uintptr_t open[3] = {(uintptr_t)name, 1 /* "rb" */, sizeof name - 1};
        file = host(SYS_OPEN, (uintptr_t)open);
    }
    const uintptr_t read[3] = {file, (uintptr_t)record, bytes};
    return host(SYS_READ, (uintptr_t)read) == 0;
}

void port_tell(const char *key, const void *words, size_t count)
{
    char line[LINE];
    line_of(line, key, words, count);
    host(SYS_WRITE0, (uintptr_t)line);
}

static void leave(uintptr_t reason)
{
    for (;;) {
        host(SYS_EXIT, reason);
    }
}

void port_check(int32_t status)
{
    if (status != KESTIRIM_STATUS_OK) {
        port_tell("failed", &status, 1);
        leave(STOPPED_RUN_TIME_ERROR);
    }
}

int main(void);

/* By the linker script. */
extern uint32_t data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];

__attribute__((noreturn, used)) void begin_program(void)
{
    volatile uint32_t *to = data_begin;
    for (const uint32_t *from = data_load; to < data_end; ++to, ++from) {
        *to = *from;
    }
    for (to = bss_begin; to < bss_end; ++to) {
        *to = 0;
    }
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: the floating-point unit is on. */
    __asm__ volatile("dsb\nisb");
#endif
    main();
    leave(STOPPED_APPLICATION_EXIT);
    for (;;) {
    }
}

#if defined(__arm__)
static void fault(void)
{
    leave(STOPPED_RUN_TIME_ERROR);
}

__attribute__((section(".start"), used)) static const void *const vectors[4] = {
    stack_top, (const void *)begin_program, (const void *)fault, (const void *)fault};
#else
__attribute__((section(".start"), naked, used)) void start(void)
{
    __asm__ volatile("la sp, stack_top\nj begin_program");
}
#endif
