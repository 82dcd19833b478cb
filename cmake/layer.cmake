# demcal_layer(FOLDER [USES FOLDER...] [PUBLIC LIBRARY...] [PRIVATE LIBRARY...] [ISA LIBRARY])
# One folder of sources, one library: uq/infer is demcal_infer. Each layer has an include root of its own, which holds
# nothing but that folder (by a link), so a file sees its own layer and those named in USES, and what those use. Another
# include does not compile: the calls in CMakeLists.txt are the arrows.
function(demcal_layer folder)
  cmake_parse_arguments(layer "" "" "USES;PUBLIC;PRIVATE" ${ARGN})
  cmake_path(GET folder FILENAME name)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  add_library(demcal_${name} STATIC ${sources})
  set_target_properties(demcal_${name} PROPERTIES UNITY_BUILD ${DEMCAL_UNITY})
  demcal_root(${folder} root)
  target_include_directories(demcal_${name} PUBLIC $<BUILD_INTERFACE:${root}> $<INSTALL_INTERFACE:include/demcal>)
  list(TRANSFORM layer_USES REPLACE "^.*/" "")
  list(TRANSFORM layer_USES PREPEND demcal_)
  target_link_libraries(demcal_${name} PUBLIC demcal_isa ${layer_USES} ${layer_PUBLIC} PRIVATE ${layer_PRIVATE})
endfunction()

# demcal_root(FOLDER VARIABLE): an include root that holds that folder alone.
function(demcal_root folder variable)
  string(MAKE_C_IDENTIFIER ${folder} name)
  set(root ${CMAKE_BINARY_DIR}/roots/${name})
  cmake_path(GET folder PARENT_PATH parent)
  file(MAKE_DIRECTORY ${root}/${parent})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  set(${variable} ${root} PARENT_SCOPE)
endfunction()
