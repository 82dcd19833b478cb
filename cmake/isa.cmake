# Instruction sets: x86-64 (any machine), x86-64-v3 (AVX2) and x86-64-v4 (AVX-512). Contact forces are compiled for each
# of DEMCAL_FORCES and chosen when the program runs; all else for DEMCAL_ISA, which `auto` makes the best of these that
# this machine has. A program for this machine alone (DEMCAL_ISA auto) needs no other contact forces than its own, which
# `auto` then leaves out: they take minutes of the compiler.
set(DEMCAL_ISA auto CACHE STRING "instruction set of all but contact forces: auto, x86-64, x86-64-v3 or x86-64-v4")
set_property(CACHE DEMCAL_ISA PROPERTY STRINGS auto x86-64 x86-64-v3 x86-64-v4)
set(DEMCAL_FORCES auto CACHE STRING "instruction sets of contact forces, the least first; auto: that of DEMCAL_ISA where it is auto, else all")

set(DEMCAL_ISA_USED ${DEMCAL_ISA})
if(DEMCAL_ISA STREQUAL auto)
  set(DEMCAL_ISA_USED x86-64)
  if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
    set(flags "${flags} ")
    if(flags MATCHES " avx2 " AND flags MATCHES " fma " AND flags MATCHES " bmi2 ")
      set(DEMCAL_ISA_USED x86-64-v3)
      if(flags MATCHES " avx512f " AND flags MATCHES " avx512bw " AND flags MATCHES " avx512cd "
         AND flags MATCHES " avx512dq " AND flags MATCHES " avx512vl ")
        set(DEMCAL_ISA_USED x86-64-v4)
      endif()
    endif()
  endif()
endif()

# demcal_isa_flags(ISA VARIABLE): the compiler's options for it.
function(demcal_isa_flags isa variable)
  if(NOT isa MATCHES "^x86-64(-v3|-v4)?$")
    message(FATAL_ERROR "the instruction set '${isa}' is not known: choose x86-64, x86-64-v3 or x86-64-v4 (DEMCAL_ISA: or auto)")
  endif()
  set(flags -march=${isa})
  if(isa STREQUAL x86-64-v4)
    # GCC 12 warns of its own AVX-512 headers, a thousand times a build. Builds for other instruction sets still look.
    list(APPEND flags -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
  set(${variable} ${flags} PARENT_SCOPE)
endfunction()

set(DEMCAL_FORCES_USED ${DEMCAL_FORCES})
if(DEMCAL_FORCES STREQUAL auto)
  set(DEMCAL_FORCES_USED x86-64 x86-64-v3 x86-64-v4)
  if(DEMCAL_ISA STREQUAL auto)
    set(DEMCAL_FORCES_USED ${DEMCAL_ISA_USED})
  endif()
endif()

demcal_isa_flags(${DEMCAL_ISA_USED} DEMCAL_ISA_FLAGS)
message(STATUS "instruction set: ${DEMCAL_ISA_USED}; of contact forces: ${DEMCAL_FORCES_USED}")
