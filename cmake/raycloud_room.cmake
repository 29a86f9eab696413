# A room is one folder of the architecture: include/raycloud/<name>/*.h and src/<name>/*.cpp, one static
# library raycloud::<name>. Its link lines are the arrows of the picture in docs/architecture.md.
#   raycloud_room(io LINKS raycloud::core PRIVATE LASzip::LASzip)
function(raycloud_room name)
  cmake_parse_arguments(ROOM "" "" "LINKS;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS
       ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp ${PROJECT_SOURCE_DIR}/src/${name}/*.h
       ${PROJECT_SOURCE_DIR}/include/raycloud/${name}/*.h)
  if(NOT sources)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp "")
    set(sources ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp)
  endif()
  add_library(raycloud_${name} ${sources})
  add_library(raycloud::${name} ALIAS raycloud_${name})
  set_target_properties(raycloud_${name} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX)
  target_compile_features(raycloud_${name} PUBLIC cxx_std_20)
  target_include_directories(raycloud_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(raycloud_${name} PUBLIC ${ROOM_LINKS}
                        PRIVATE ${ROOM_PRIVATE} $<BUILD_INTERFACE:raycloud_build>)
  raycloud_precompiled(raycloud_${name} library)
  set_property(GLOBAL APPEND PROPERTY RAYCLOUD_ROOMS ${name})
endfunction()
