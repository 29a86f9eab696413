# What is installed and how others find it: find_package(raycloud), pkg-config raycloud, the commands with their
# manual pages and completions. tests/install builds users of the installed tree.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY RAYCLOUD_ROOMS)
get_property(commands GLOBAL PROPERTY RAYCLOUD_COMMANDS)
add_custom_target(commands)  # everything a user of the commands needs, without the tests

# The library.
list(TRANSFORM rooms PREPEND raycloud_ OUTPUT_VARIABLE room_targets)
install(TARGETS ${room_targets} EXPORT raycloudTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/raycloud DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# For CMake. stb is compiled in; Eigen, oneTBB, LASzip and Embree are found again where the library is used.
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/raycloud)
install(EXPORT raycloudTargets NAMESPACE raycloud:: DESTINATION ${config_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/raycloudConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/raycloudConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/raycloudConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/raycloudConfig.cmake ${PROJECT_BINARY_DIR}/raycloudConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindLASzip.cmake ${CMAKE_CURRENT_LIST_DIR}/FindEmbree.cmake
        DESTINATION ${config_dir})

# For pkg-config. A static library comes before those it uses; rooms are declared the other way round.
list(REVERSE rooms)
list(TRANSFORM rooms PREPEND -lraycloud_)
list(JOIN rooms " " pc_libraries)
foreach(library ${LASzip_LIBRARY} ${Embree_LIBRARY})
  cmake_path(GET library PARENT_PATH library_dir)
  if(NOT library_dir IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
    string(APPEND pc_libraries " -L${library_dir}")
  endif()
endforeach()
cmake_path(GET Embree_LIBRARY STEM embree_name)
string(REGEX REPLACE "^lib" "-l" pc_embree ${embree_name})
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${pc_dir}
           OUTPUT_VARIABLE pc_prefix)
configure_file(${CMAKE_CURRENT_LIST_DIR}/raycloud.pc.in ${PROJECT_BINARY_DIR}/raycloud.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/raycloud.pc DESTINATION ${pc_dir})

# The commands; each writes its own manual page and completions.
foreach(command IN LISTS commands)
  set(generated)
  foreach(page "man man/man1/${command}.1" "bash bash-completion/completions/${command}"
               "zsh zsh/site-functions/_${command}" "fish fish/vendor_completions.d/${command}.fish")
    separate_arguments(page)
    list(GET page 0 kind)
    list(GET page 1 file)
    set(path ${PROJECT_BINARY_DIR}/share/${file})
    cmake_path(GET path PARENT_PATH folder)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(OUTPUT ${path} COMMAND ${command} --generate ${kind} > ${path} DEPENDS ${command} VERBATIM)
    list(APPEND generated ${path})
  endforeach()
  add_custom_target(${command}_pages ALL DEPENDS ${generated})
  add_dependencies(commands ${command} ${command}_pages)
endforeach()
if(commands)
  install(TARGETS ${commands})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR})
endif()
