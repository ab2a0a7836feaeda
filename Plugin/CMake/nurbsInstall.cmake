# Install rules of the package as a whole: find_package(vtkNURBS) gives VTKNURBS::* and nurbs::*.

include(CMakePackageConfigHelpers)

install(EXPORT nurbsTargets
  NAMESPACE nurbs::
  FILE nurbs-targets.cmake
  DESTINATION "${NURBS_CMAKE_DESTINATION}"
  COMPONENT development)
export(EXPORT nurbsTargets
  NAMESPACE nurbs::
  FILE "${CMAKE_BINARY_DIR}/${NURBS_CMAKE_DESTINATION}/nurbs-targets.cmake")
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/vtkNURBSConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/${NURBS_CMAKE_DESTINATION}/vtknurbs-config.cmake"
  INSTALL_DESTINATION "${NURBS_CMAKE_DESTINATION}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${NURBS_CMAKE_DESTINATION}/vtknurbs-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_BINARY_DIR}/${NURBS_CMAKE_DESTINATION}/vtknurbs-config.cmake"
  "${CMAKE_BINARY_DIR}/${NURBS_CMAKE_DESTINATION}/vtknurbs-config-version.cmake"
  DESTINATION "${NURBS_CMAKE_DESTINATION}"
  COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/LICENSE.note"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/licenses/vtkNURBS"
  COMPONENT licenses)
