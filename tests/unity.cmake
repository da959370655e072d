# Unity by ThrowTheSwitch: installed, else its pinned release, else (no access to that) the copy in
# Debian's source package of cJSON, which tools/setup unpacks into build/third_party.
include(FetchContent)
find_package(unity QUIET)
if(unity_FOUND)
  # Unity is usually built without what compares doubles.
  include(CheckCSourceCompiles)
  set(CMAKE_REQUIRED_DEFINITIONS -DUNITY_INCLUDE_DOUBLE -DUNITY_SUPPORT_64)
  set(CMAKE_REQUIRED_LIBRARIES unity::framework)
  check_c_source_compiles("
    #include <unity.h>
    void setUp(void) {}
    void tearDown(void) {}
    int main(void) { TEST_ASSERT_EQUAL_DOUBLE(1.0, 1.0); return 0; }" FLEXCOMP_UNITY_HAS_DOUBLE)
  unset(CMAKE_REQUIRED_DEFINITIONS)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(unity_FOUND AND FLEXCOMP_UNITY_HAS_DOUBLE)
  add_library(flexcomp_unity INTERFACE)
  target_link_libraries(flexcomp_unity INTERFACE unity::framework)
  target_compile_definitions(flexcomp_unity INTERFACE UNITY_INCLUDE_DOUBLE= UNITY_SUPPORT_64=)
else()
  set(debian_unity ${PROJECT_SOURCE_DIR}/build/third_party/unity)
  if(NOT FETCHCONTENT_SOURCE_DIR_UNITY AND EXISTS ${debian_unity}/src/unity.c)
    set(FETCHCONTENT_SOURCE_DIR_UNITY ${debian_unity})
  endif()
  FetchContent_Declare(unity
    GIT_REPOSITORY https://github.com/ThrowTheSwitch/Unity.git
    GIT_TAG cbcd08fa7de711053a3deec6339ee89cad5d2697 # v2.6.1
    SOURCE_SUBDIR no-build-files-of-its-own)
  FetchContent_MakeAvailable(unity)
  add_library(flexcomp_unity STATIC ${unity_SOURCE_DIR}/src/unity.c)
  target_include_directories(flexcomp_unity SYSTEM PUBLIC ${unity_SOURCE_DIR}/src)
  target_compile_definitions(flexcomp_unity PUBLIC UNITY_INCLUDE_DOUBLE=
                             UNITY_SUPPORT_64=)
endif()
