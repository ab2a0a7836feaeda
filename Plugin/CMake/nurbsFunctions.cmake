# The few functions that the rooms' CMakeLists.txt are written with.

# nurbs_existing(<out> <file>...): the files, each of which must exist in the current source directory.
function (nurbs_existing out)
  foreach (file IN LISTS ARGN)
    if (NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
      message(FATAL_ERROR "${CMAKE_CURRENT_SOURCE_DIR} has no ${file}, which is listed there")
    endif ()
  endforeach ()
  set("${out}" "${ARGN}" PARENT_SCOPE)
endfunction ()

# nurbs_existing_modules(<out> <vtk.module>...): those whose room has a vtk*.cxx already.
function (nurbs_existing_modules out)
  set(found)
  foreach (file IN LISTS ARGN)
    get_filename_component(room "${file}" DIRECTORY)
    file(GLOB classes CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${room}/vtk*.cxx")
    if (classes)
      list(APPEND found "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
    endif ()
  endforeach ()
  set("${out}" "${found}" PARENT_SCOPE)
endfunction ()

function (nurbs_warnings target)
  target_compile_options("${target}" PRIVATE
    -Wall -Wextra "$<$<BOOL:${NURBS_WERROR}>:-Werror>")
endfunction ()

# nurbs_add_kernel(<Name> SOURCES <.cxx>... [HEADERS <.h>...] [CGAL_SOURCES <.cxx>...]
#                  [LINK <target>...])
# A library nurbs<Name>, alias nurbs::<Name>, that knows neither VTK nor OpenCASCADE.
# CGAL_SOURCES are compiled for CGAL's interval arithmetic; no other file pays for it.
function (nurbs_add_kernel name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;CGAL_SOURCES;LINK" ${ARGN})
  set(target "nurbs${name}")
  nurbs_existing(sources ${arg_SOURCES} ${arg_CGAL_SOURCES})
  nurbs_existing(headers ${arg_HEADERS})
  nurbs_existing(cgal_sources ${arg_CGAL_SOURCES})
  if (NOT sources)
    add_library("${target}" INTERFACE)
    set(scope INTERFACE)
  else ()
    add_library("${target}" SHARED ${sources} ${headers})
    set(scope PUBLIC)
    nurbs_warnings("${target}")
    set_target_properties("${target}" PROPERTIES
      VERSION "${PROJECT_VERSION}"
      SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
  endif ()
  add_library("nurbs::${name}" ALIAS "${target}")
  set_target_properties("${target}" PROPERTIES EXPORT_NAME "${name}")
  target_compile_features("${target}" ${scope} cxx_std_17)
  target_link_libraries("${target}" ${scope} Eigen3::Eigen Threads::Threads ${arg_LINK})
  target_include_directories("${target}" ${scope}
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>"
    "$<INSTALL_INTERFACE:${NURBS_HEADERS_DESTINATION}/${name}>")
  if (cgal_sources)
    find_package(CGAL REQUIRED QUIET)
    get_target_property(cgal_includes CGAL::CGAL INTERFACE_INCLUDE_DIRECTORIES)
    if (cgal_includes)
      target_include_directories("${target}" SYSTEM PRIVATE ${cgal_includes})
    endif ()
    target_link_libraries("${target}" PRIVATE gmp mpfr)
    set(cgal_options -frounding-math -ftrapping-math)
    if (NURBS_SANITIZE)
      # CGAL's arrangements cast their faces to a class they are not, whence no vptr check there.
      list(APPEND cgal_options -fno-sanitize=vptr)
    endif ()
    set_source_files_properties(${cgal_sources} PROPERTIES COMPILE_OPTIONS "${cgal_options}")
  endif ()
  install(TARGETS "${target}" EXPORT nurbsTargets
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime
    NAMELINK_COMPONENT development)
  install(FILES ${headers} DESTINATION "${NURBS_HEADERS_DESTINATION}/${name}"
    COMPONENT development)
endfunction ()

# nurbs_add_vtk_module(<Namespace::Name> CLASSES <vtkClass>... [SOURCES <.cxx>...] [HEADERS <.h>...]
#                      [GENERATED <file>...] [KERNEL <target>...] [LINK <target>...])
# The VTK module of the current room. CLASSES are vtk*.{h,cxx}; SOURCES further files of the library,
# HEADERS those of their headers that users may include (installed, not wrapped); KERNEL targets whose
# headers our own headers may include; LINK private libraries.
function (nurbs_add_vtk_module name)
  cmake_parse_arguments(arg "" "" "CLASSES;SOURCES;HEADERS;GENERATED;KERNEL;LINK" ${ARGN})
  if (NURBS_KERNEL_ONLY)
    return ()
  endif ()
  set(wanted)
  foreach (class IN LISTS arg_CLASSES)
    list(APPEND wanted "${class}.cxx")
  endforeach ()
  nurbs_existing(present ${wanted})
  if (NOT present)
    return ()
  endif ()
  string(REPLACE ".cxx" "" classes "${present}")
  nurbs_existing(sources ${arg_SOURCES})
  nurbs_existing(headers ${arg_HEADERS})
  vtk_module_add_module("${name}"
    CLASSES ${classes}
    SOURCES ${sources} ${arg_GENERATED}
    NOWRAP_HEADERS ${headers})
  vtk_module_link("${name}" PUBLIC ${arg_KERNEL} PRIVATE ${arg_LINK})
  vtk_module_compile_options("${name}" PRIVATE
    -Wall -Wextra "$<$<BOOL:${NURBS_WERROR}>:-Werror>")
endfunction ()
