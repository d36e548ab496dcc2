@ Comparisons: r0 and r1 in, 1 or 0 in r0 out; changes r1, r2, r3 and the flags. With a NaN all but the last say 0.
@
@ Numbers that are not negative are ordered as their bits are; of negative ones the sign is the integer's after
@ a subtraction from 2³¹, which also makes the two zeros one.

    .syntax unified

    .macro order name, a, b, unless
    .pushsection .text.\name,"ax",%progbits
    .p2align 1
    .thumb
    .weak \name
    .type \name,%function
    .thumb_func
\name:
    movs r3, r0
    orrs r3, r1
    bmi  3f
1:  cmp  \a, \b
    \unless 2f
    movs r2, #255
    lsls r2, r2, #23
    cmp  \b, r2                 @ A NaN is more than infinity.
    bgt  2f
    movs r0, #1
    bx   lr
2:  movs r0, #0
    bx   lr
3:  movs r2, #255
    lsls r2, r2, #24
    lsls r3, r0, #1
    cmp  r3, r2
    bhi  2b
    lsls r3, r1, #1
    cmp  r3, r2
    bhi  2b
    movs r2, #1
    lsls r2, r2, #31
    cmp  r0, #0
    bge  4f
    subs r0, r2, r0
4:  cmp  r1, #0
    bge  1b
    subs r1, r2, r1
    b    1b
    .size \name, . - \name
    .popsection
    .endm

    order __aeabi_fcmplt, r0, r1, bge
    order __aeabi_fcmple, r0, r1, bgt
    order __aeabi_fcmpgt, r1, r0, bge
    order __aeabi_fcmpge, r1, r0, bgt
    .purgem order

    .pushsection .text.__aeabi_fcmpeq,"ax",%progbits
    .p2align 1
    .thumb
    .weak __aeabi_fcmpeq
    .type __aeabi_fcmpeq,%function
    .thumb_func
__aeabi_fcmpeq:
    cmp  r0, r1
    bne  2f
    lsls r0, r0, #1
    movs r2, #255
    lsls r2, r2, #24
    cmp  r0, r2
    bhi  3f
1:  movs r0, #1
    bx   lr
2:  orrs r0, r1
    lsls r0, r0, #1
    beq  1b                     @ both zeros
3:  movs r0, #0
    bx   lr
    .size __aeabi_fcmpeq, . - __aeabi_fcmpeq
    .popsection

    .pushsection .text.__aeabi_fcmpun,"ax",%progbits
    .p2align 1
    .thumb
    .weak __aeabi_fcmpun
    .type __aeabi_fcmpun,%function
    .thumb_func
__aeabi_fcmpun:
    movs r2, #255
    lsls r2, r2, #24
    lsls r0, r0, #1
    cmp  r0, r2
    bhi  1f
    lsls r1, r1, #1
    cmp  r1, r2
    bhi  1f
    movs r0, #0
    bx   lr
1:  movs r0, #1
    bx   lr
    .size __aeabi_fcmpun, . - __aeabi_fcmpun
    .popsection
