@ a / b: r0 and r1 in, r0 out.

    .syntax unified
    .pushsection .text.__aeabi_fdiv,"ax",%progbits
    .p2align 1
    .thumb
    .weak __aeabi_fdiv
    .type __aeabi_fdiv,%function
    .thumb_func
__aeabi_fdiv:
    push {{r4, lr}}
    bl   {every_case}
    pop  {{r4, pc}}
    .size __aeabi_fdiv, . - __aeabi_fdiv
    .popsection
