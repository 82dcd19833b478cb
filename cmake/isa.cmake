# The instruction set of the build: x86-64 (any machine), x86-64-v3 (AVX2), x86-64-v4 (AVX-512), or auto:
# the best of these that this machine has. Results are the same bits within one of them, so it is recorded
# with every run (data/provenance.hpp reads DEMCAL_ISA).
set(DEMCAL_ISA auto CACHE STRING "instruction set: auto, x86-64, x86-64-v3 or x86-64-v4")
set_property(CACHE DEMCAL_ISA PROPERTY STRINGS auto x86-64 x86-64-v3 x86-64-v4)

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
if(NOT DEMCAL_ISA_USED MATCHES "^x86-64(-v3|-v4)?$")
  message(FATAL_ERROR "DEMCAL_ISA is '${DEMCAL_ISA}': choose auto, x86-64, x86-64-v3 or x86-64-v4")
endif()
set(DEMCAL_ISA_FLAGS -march=${DEMCAL_ISA_USED})
if(DEMCAL_ISA_USED STREQUAL x86-64-v4)
  list(APPEND DEMCAL_ISA_FLAGS -Wno-maybe-uninitialized)  # GCC 12's own AVX-512 headers
endif()
message(STATUS "instruction set: ${DEMCAL_ISA_USED}")
