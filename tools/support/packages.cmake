# Debian packages, which tools/package makes: the command, the process on the bus, the library.
foreach(package IN ITEMS flexcomp flexcompd libflexcomp-dev)
  string(REGEX REPLACE "^lib.*-" "" component ${package})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          RENAME copyright COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          RENAME changelog COMPONENT ${component})
  string(TOUPPER ${component} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${package})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL flexcomp flexcompd dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
# The unit says where it will stand, not where it is packed.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The authors of flexcomp <flexcomp@localhost>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FLEXCOMP_PACKAGE_SECTION science)
# Without pictures there is no report, and a diagnosis writes all of its files or none.
set(CPACK_DEBIAN_FLEXCOMP_PACKAGE_DEPENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_FLEXCOMP_PACKAGE_SUGGESTS flexcompd)
set(CPACK_DEBIAN_FLEXCOMPD_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FLEXCOMPD_PACKAGE_SUGGESTS flexcomp)
set(CPACK_DEBIAN_FLEXCOMPD_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/tools/support/packages/postinst)
set(CPACK_DEBIAN_FLEXCOMPD_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
# For programs in C++; those in C need no Eigen.
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS libeigen3-dev)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # it would come first in all of them
set(CPACK_DEBIAN_FLEXCOMP_DESCRIPTION
  "correction of the path of robots that bend under cutting forces
Plans paths, makes tables of a robot's compliance with a certified error,
corrects programs, judges circularity, and finds out from a recording why a
robot does not move as its model says.")
set(CPACK_DEBIAN_FLEXCOMPD_DESCRIPTION
  "real-time correction of a robot's setpoints on CAN, LCM or RSI
The process, a hardened systemd unit, and the descriptions of all messages for
other clients of the bus. Not a safety function.")
set(CPACK_DEBIAN_DEV_DESCRIPTION
  "library that corrects a robot's setpoints in its controller
For C and C++: no heap, no exceptions, no locks. Programs in C++ need Eigen
beside it, programs in C do not.")
include(CPack)
