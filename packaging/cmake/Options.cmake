# shaken::options carries every compiler flag; nothing else in the project sets one.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # depend mode: a file that is not in the cache is read once, not once by the preprocessor and again by the compiler;
  # the sloppiness is what precompiled headers ask for (no file of ours writes the time into the program)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

add_library(shaken_options INTERFACE)
add_library(shaken::options ALIAS shaken_options)
target_include_directories(shaken_options INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include/shaken>)
target_compile_features(shaken_options INTERFACE cxx_std_20)
target_compile_options(shaken_options INTERFACE
  -pthread  # everywhere: a precompiled header serves only files that see the same macros
  # warnings are for this project; who links the libraries has his own
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wnon-virtual-dtor>"
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>  # g++ 12 sees overlaps in "text" + std::string that are not there (GCC bug 105651)
  # One rounding per operation, on every machine and at every optimisation level: the steppers promise bitwise equal
  # trajectories, and a fused multiply-add in one of two copies of a kernel breaks that.
  -ffp-contract=off
  # Square roots and comparisons may become vector instructions; no result depends on errno or on floating-point traps.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_options(shaken_options INTERFACE "$<BUILD_INTERFACE:SHELL:-Xclang -fno-pch-timestamp>")  # else ccache keeps none of it
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # files that are read through another one may have unnamed namespaces all the same
  target_compile_options(shaken_options INTERFACE $<BUILD_INTERFACE:-Wno-subobject-linkage>)
endif()
# Builds with sanitizers: what waits for files and sockets is not optimised, which halves the time to compile it; what
# computes (a library says target_compile_options(NAME PRIVATE ${SHAKEN_COMPUTES})) is, or its tests would take too long.
set(CMAKE_CXX_FLAGS_SANITIZE "-O0 -g1")
set(SHAKEN_COMPUTES $<$<CONFIG:Sanitize>:-O2>)
# What waits for sockets and files is fast enough if it is compiled soon.
set(SHAKEN_WAITS $<$<CONFIG:Release>:-O1>)
# A program that steps for long comes twice: NAME for any x86-64, and NAME-wide, whose simulator is compiled for AVX2,
# FMA and BMI, with optimisation across objects. NAME goes on as that where the processor can (base/process.h). The
# trajectory is the same to the bit, in about a tenth less CPU time.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  set(SHAKEN_WIDE -mavx2 -mfma -mbmi -mbmi2 -flto=auto)
endif()
file(GLOB former ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/*-wide)
if(former AND NOT SHAKEN_WIDE)
  file(REMOVE ${former})  # of another simulator by now
endif()
# shaken_steps_for_long(NAME source LIBRARY ...): such a program, of one file that both builds link.
function(shaken_steps_for_long name source)
  add_library(${name}-main OBJECT ${source})
  target_precompile_headers(${name}-main REUSE_FROM shaken_headers_words)
  target_link_libraries(${name}-main PRIVATE ${ARGN})
  add_executable(${name} $<TARGET_OBJECTS:${name}-main>)
  target_link_libraries(${name} PRIVATE ${ARGN})
  if(SHAKEN_WIDE)
    add_executable(${name}-wide $<TARGET_OBJECTS:${name}-main> $<TARGET_OBJECTS:shaken_sim_wide>)
    set_target_properties(${name}-wide PROPERTIES LINK_OPTIONS -flto=auto)
    target_link_libraries(${name}-wide PRIVATE ${ARGN})
    add_dependencies(${name} ${name}-wide)  # that no other simulator's is beside it
  endif()
endfunction()
# LLVM's linker, where there is one, takes a quarter of the CPU time: for what is not shipped.
find_program(LLD ld.lld)
set(SHAKEN_QUICK_LINK $<$<AND:$<BOOL:${LLD}>,$<NOT:$<BOOL:${CMAKE_CROSSCOMPILING}>>>:-fuse-ld=lld>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_link_options(${SHAKEN_QUICK_LINK})
endif()
# Eigen adds up in another order where vectors are wider, and its small fixed sizes gain nothing from them.
target_compile_definitions(shaken_options INTERFACE EIGEN_DONT_VECTORIZE)
if(SHAKEN_WERROR)
  target_compile_options(shaken_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(SHAKEN_ARCH)
  target_compile_options(shaken_options INTERFACE -march=${SHAKEN_ARCH})
endif()
if(SHAKEN_SANITIZE)
  target_compile_options(shaken_options INTERFACE -fsanitize=${SHAKEN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(shaken_options INTERFACE -fsanitize=${SHAKEN_SANITIZE})
endif()
