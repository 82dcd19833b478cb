# Included, not a directory of its own: a file that a command makes is known to targets of the same directory alone.

# Under sanitizers -O3 and the analysis of pointers cost the compiler minutes per file and find nothing more.
if(DEMCAL_SANITIZE)
  set(optimise $<$<CXX_COMPILER_ID:GNU>:-fno-tree-pta>)
else()
  set(optimise $<$<NOT:$<CONFIG:Debug>>:-O3>)
endif()
# The numerics: -O3 for the lane loops; no contraction into fused operations, so that one thread and several (which are
# different code) and all instruction sets round alike; no errno and no traps, which only keep loops from vectorising.
set(numerics -ffp-contract=off -fno-math-errno -fno-trapping-math ${optimise})
foreach(layer walls contact engine case rig bed reading forecast run)
  target_compile_options(demcal_${layer} PRIVATE ${numerics})
endforeach()

# The force pass (contact/forces/), compiled once for each instruction set of DEMCAL_FORCES_USED; isa.cpp takes the widest that the
# processor has. Each becomes one object file in which all but its entry is local: else the linker would keep one of
# several copies of a template or inline function, and run it on processors that it was not compiled for.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/dem/contact/forces/*.cpp)
set(made ${CMAKE_BINARY_DIR}/dem)
file(MAKE_DIRECTORY ${made})
set(table "// Instruction sets that contact forces are compiled for, the least first; made by CMake.\n")
foreach(isa IN LISTS DEMCAL_FORCES_USED)
  string(MAKE_C_IDENTIFIER demcal_forces_${isa} entry)
  add_library(${entry} OBJECT ${sources})
  target_link_libraries(${entry} PRIVATE demcal_flags)
  target_include_directories(${entry} PRIVATE $<TARGET_PROPERTY:demcal_contact,INCLUDE_DIRECTORIES>)
  demcal_isa_flags(${isa} flags)
  target_compile_options(${entry} PRIVATE ${numerics} ${flags} $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  target_compile_definitions(${entry} PRIVATE DEMCAL_FORCES_ENTRY=${entry})
  set(object ${made}/${entry}.o)
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object}.all $<TARGET_OBJECTS:${entry}>
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${entry} ${object}.all ${object}
    DEPENDS $<TARGET_OBJECTS:${entry}>
    COMMAND_EXPAND_LISTS VERBATIM)
  target_sources(demcal_contact PRIVATE ${object})
  string(APPEND table "FORCES(\"${isa}\", ${entry})\n")
endforeach()
file(CONFIGURE OUTPUT ${made}/forces.inc CONTENT "${table}")
target_include_directories(demcal_contact PRIVATE ${made})
