# One CMake target a room: ensonify_room(core SOURCES pose.cpp PUBLIC Eigen3::Eigen PRIVATE fmt::fmt)
# Headers are included as "ensonify/<room>/<file>.hpp", in the tree (through a link) and installed alike.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(default_arch x86-64-v3)
else()
  set(default_arch "")
endif()
set(ENSONIFY_ARCH "${default_arch}" CACHE STRING "-march of the build; empty: the compiler's baseline")

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# Flags of our own code only; none of them reaches a user of the library.
# -ffp-contract=off: the same bits from every compiler. -fno-math-errno, -fno-trapping-math: vector code, no change of values.
add_library(ensonify_flags INTERFACE)
target_compile_options(ensonify_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(ENSONIFY_ARCH)
  target_compile_options(ensonify_flags INTERFACE -march=${ENSONIFY_ARCH})
endif()
if(ENSONIFY_WERROR)
  target_compile_options(ensonify_flags INTERFACE -Werror)
endif()
if(ENSONIFY_SANITIZE)
  target_compile_options(ensonify_flags INTERFACE -fsanitize=${ENSONIFY_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(ensonify_flags INTERFACE -fsanitize=${ENSONIFY_SANITIZE})
endif()
if(ENSONIFY_COVERAGE)
  target_compile_options(ensonify_flags INTERFACE --coverage)
  target_link_options(ensonify_flags INTERFACE --coverage)
endif()

function(ensonify_room room)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/ensonify)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/ensonify/${room} SYMBOLIC)
  set(target ensonify_${room})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(ensonify::${room} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${room})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:ensonify_flags>)
  install(TARGETS ${target} EXPORT ensonify ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ensonify/${room}
    FILES_MATCHING PATTERN "*.hpp" PATTERN library EXCLUDE)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/library)
    # Programs look for share/ensonify beside and above themselves, in the build tree as where they are installed.
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share/ensonify)
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/share/ensonify/${room} SYMBOLIC)
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/library
      DESTINATION ${CMAKE_INSTALL_DATADIR}/ensonify/${room})
  endif()
endfunction()
