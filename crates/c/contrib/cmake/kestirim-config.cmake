# find_package(kestirim REQUIRED PATHS …/crates/c/contrib/cmake) and link kestirim::kestirim.
set(KESTIRIM_TARGET "" CACHE STRING "Rust target, such as thumbv7em-none-eabihf; empty: this computer")
option(KESTIRIM_FIXED "Compute in fixed point, without a floating-point unit" OFF)
get_filename_component(kestirim_crate "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
set(KESTIRIM_BUILD "${CMAKE_BINARY_DIR}/kestirim" CACHE PATH "Where cargo builds")
set(kestirim_archive "${KESTIRIM_BUILD}/${KESTIRIM_TARGET}/release-s/libkestirim.a")
set(kestirim_options --locked --profile release-s --target-dir "${KESTIRIM_BUILD}")
if(KESTIRIM_TARGET)
  list(APPEND kestirim_options --target "${KESTIRIM_TARGET}")
endif()
if(KESTIRIM_FIXED)
  list(APPEND kestirim_options --features fixed)
endif()
add_custom_target(kestirim_cargo BYPRODUCTS "${kestirim_archive}" VERBATIM USES_TERMINAL
  COMMAND cargo build ${kestirim_options} WORKING_DIRECTORY "${kestirim_crate}/staticlib")
add_library(kestirim::kestirim STATIC IMPORTED GLOBAL)
set_target_properties(kestirim::kestirim PROPERTIES IMPORTED_LOCATION "${kestirim_archive}"
  INTERFACE_INCLUDE_DIRECTORIES "${kestirim_crate}/include")
add_dependencies(kestirim::kestirim kestirim_cargo)
