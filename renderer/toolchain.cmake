# What every target of ours is built with, and the packages they are built on.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Precompiled headers need these two relaxations; see ccache's manual, "Precompiled headers".
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()

# The least processor: x86-64 level 2, SSE4.2. A directory's option stands before the targets' own, so that the kernels'
# levels override it.
add_compile_options(-march=x86-64-v2)
add_library(lumi_options INTERFACE)
# -ffp-contract=off: results must not depend on where the compiler finds a fused multiply-add.
target_compile_options(lumi_options INTERFACE -Wall -Wextra -Wshadow -Wno-unused-parameter -ffp-contract=off
                                              -fpch-preprocess)
if(LUMISCOPE_WARNINGS_AS_ERRORS)
  target_compile_options(lumi_options INTERFACE -Werror)
endif()
if(LUMISCOPE_SANITIZE)
  target_compile_options(lumi_options INTERFACE -fsanitize=${LUMISCOPE_SANITIZE} -fno-omit-frame-pointer -g1
                                                -fno-sanitize-recover=all)
  target_link_options(lumi_options INTERFACE -fsanitize=${LUMISCOPE_SANITIZE})
endif()
target_compile_definitions(lumi_options INTERFACE GLM_ENABLE_EXPERIMENTAL)
target_include_directories(lumi_options INTERFACE ${CMAKE_SOURCE_DIR}/renderer ${CMAKE_SOURCE_DIR})

# lumi_library(NAME SOURCES a.cpp ... [KERNELS k.cpp ...] [LINKS target ...] [PCH "header" ...])
# KERNELS are compiled once for each instruction set: LUMI_ISA names the namespace, one of baseline, v3, v4
# (the x86-64 levels); base/isa.h chooses among them at run time.
function(lumi_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;KERNELS;LINKS;PCH" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC lumi_options ${arg_LINKS})
  foreach(kernel IN LISTS arg_KERNELS)
    get_filename_component(stem ${kernel} NAME_WE)
    foreach(level baseline v3 v4)
      set(variant ${name}_${stem}_${level})
      add_library(${variant} OBJECT ${kernel})
      target_link_libraries(${variant} PRIVATE lumi_options ${arg_LINKS})
      target_compile_definitions(${variant} PRIVATE LUMI_ISA=${level})
      # Neither flag changes a value; without them no loop with a choice or a square root vectorises.
      target_compile_options(${variant} PRIVATE -O3 -fno-trapping-math -fno-math-errno)
      if(level STREQUAL v3)
        target_compile_options(${variant} PRIVATE -march=x86-64-v3)
      elseif(level STREQUAL v4)
        target_compile_options(${variant} PRIVATE -march=x86-64-v4 -mprefer-vector-width=512)
      endif()
      target_sources(${name} PRIVATE $<TARGET_OBJECTS:${variant}>)
    endforeach()
  endforeach()
  if(arg_PCH)
    target_precompile_headers(${name} PRIVATE ${arg_PCH})
  endif()
endfunction()

# Packages. Debian's OpenSubdiv config names a static library that is not shipped, so it is found by hand.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(glfw3 3.3 REQUIRED)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
find_path(OSD_INCLUDE_DIR opensubdiv/bfr/surfaceFactory.h REQUIRED)
find_library(OSD_LIBRARY osdCPU REQUIRED)
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_library(TINYGLTF_LIBRARY tinygltf REQUIRED)
find_library(TINYOBJ_LIBRARY tinyobjloader REQUIRED)
find_library(DRACO_LIBRARY libdraco.so REQUIRED)
find_library(MESHOPTIMIZER_LIBRARY meshoptimizer REQUIRED)
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
