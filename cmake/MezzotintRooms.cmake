# A room of the house: one folder, one library, one test program.
#
#   mezzotint_room(FOLDER forward/surface USES forward/base PRIVATE fmt::fmt)
#
# makes mezzotint::forward_surface from forward/surface/*.cpp. USES names the rooms below, so that the
# link lines draw the diagram of design.md; PRIVATE names libraries that only the .cpp files see.

add_library(mezzotint_compile_options INTERFACE)
target_compile_options(mezzotint_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Wno-missing-field-initializers  # designated initialisers leave the documented defaults in place
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 warns of std::string + const char* in its own headers (bug 105651)
  -ffp-contract=off)  # the same bits whatever the compiler may fuse

function(mezzotint_room)
  cmake_parse_arguments(ROOM "" "FOLDER" "USES;PUBLIC;PRIVATE" ${ARGN})
  string(REPLACE "/" "_" name ${ROOM_FOLDER})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${ROOM_FOLDER}/*.cpp)
  add_library(mezzotint_${name} STATIC ${sources})
  add_library(mezzotint::${name} ALIAS mezzotint_${name})
  target_include_directories(mezzotint_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  foreach(used IN LISTS ROOM_USES)
    string(REPLACE "/" "_" used ${used})
    target_link_libraries(mezzotint_${name} PUBLIC mezzotint_${used})
  endforeach()
  target_link_libraries(mezzotint_${name} PUBLIC ${ROOM_PUBLIC}
    PRIVATE ${ROOM_PRIVATE} mezzotint_compile_options)
endfunction()

# mezzotint_house(forward ROOMS base surface): one name for all rooms of a top-level folder.
function(mezzotint_house house)
  cmake_parse_arguments(HOUSE "" "" "ROOMS" ${ARGN})
  add_library(mezzotint_${house} INTERFACE)
  add_library(mezzotint::${house} ALIAS mezzotint_${house})
  foreach(room IN LISTS HOUSE_ROOMS)
    target_link_libraries(mezzotint_${house} INTERFACE mezzotint_${house}_${room})
  endforeach()
endfunction()

# mezzotint_tests(FOLDER forward/surface): tests/forward/surface/*_test.cpp into one program.
function(mezzotint_tests)
  cmake_parse_arguments(TESTS "" "FOLDER" "PRIVATE;DEFINITIONS" ${ARGN})
  string(REPLACE "/" "_" name ${TESTS_FOLDER})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${TESTS_FOLDER}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(tests_${name} ${sources})
  target_link_libraries(tests_${name} PRIVATE mezzotint_test_support ${TESTS_PRIVATE}
    GTest::gtest_main mezzotint_compile_options)
  target_compile_definitions(tests_${name} PRIVATE ${TESTS_DEFINITIONS})
  if(TARGET mezzotint_${name})
    target_link_libraries(tests_${name} PRIVATE mezzotint_${name})
  endif()
  gtest_discover_tests(tests_${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
