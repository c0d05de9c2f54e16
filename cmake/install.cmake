# What goes where, and the packages that are made of it: `cmake --install build/release --prefix DIR`, `tools/package`.
#
#   cgsr             the robot: program, service, configuration, maps
#   cgsr-opengl      the expected view by Mesa (localizer.expectation = "opengl"), whose compiler is larger than all the rest
#   cgsr-simulator   the simulated home, its worlds and tools: the ray tracer
#   cgsr-map         `cgsr map refine`: the solver Ceres
#   cgsr-lab         the measurements of `cgsr reproduce`
#
# Programs and plug-ins lie in one folder, for each finds the others beside itself; /usr/bin holds a link.
include(GNUInstallDirs)
set(CGSR_PRIVATE_DIR lib/cgsr)
set(CGSR_SHARE_DIR share/cgsr)

install(TARGETS cgsr RUNTIME DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr)
install(TARGETS cgsr_opengl_plugin LIBRARY DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr-opengl)
install(TARGETS cgsr_sim_plugin LIBRARY DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr-simulator)
install(TARGETS cgsr-sim RUNTIME DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr-simulator)
install(TARGETS cgsr-map RUNTIME DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr-map)
install(TARGETS cgsr-lab RUNTIME DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr-lab)
install(CODE "
  file(MAKE_DIRECTORY \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/bin\")
  file(CREATE_LINK ../${CGSR_PRIVATE_DIR}/cgsr \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/bin/cgsr\" SYMBOLIC)" COMPONENT cgsr)

# Configuration: what a robot's file may extend or name, relative to each other as in the sources.
install(DIRECTORY config/robots config/models config/maps config/illumination config/localization
        DESTINATION ${CGSR_SHARE_DIR} COMPONENT cgsr PATTERN "sim-*.toml" EXCLUDE)
install(DIRECTORY config/robots DESTINATION ${CGSR_SHARE_DIR} COMPONENT cgsr-simulator FILES_MATCHING PATTERN "sim-*.toml")
install(DIRECTORY config/scenarios config/worlds DESTINATION ${CGSR_SHARE_DIR} COMPONENT cgsr-simulator)

# The service. /etc/cgsr is the administrator's: the package keeps his changes.
install(FILES config/service/robot.toml DESTINATION /etc/cgsr COMPONENT cgsr)
install(FILES config/service/cgsr.service DESTINATION lib/systemd/system COMPONENT cgsr)
install(FILES config/service/cgsr.sysusers DESTINATION lib/sysusers.d RENAME cgsr.conf COMPONENT cgsr)
install(FILES config/service/cgsr.modules-load DESTINATION lib/modules-load.d RENAME cgsr.conf COMPONENT cgsr)
install(FILES config/udev/70-cgsr.rules DESTINATION lib/udev/rules.d COMPONENT cgsr)
install(FILES config/network/80-cgsr-can.network DESTINATION lib/systemd/network COMPONENT cgsr)
install(PROGRAMS config/service/restart-pause DESTINATION ${CGSR_PRIVATE_DIR} COMPONENT cgsr)

# Written by the program about itself, by the target package_files (tools/package builds it).
set(CGSR_PACKAGE_FILES ${CMAKE_BINARY_DIR}/package)
add_custom_target(package_files
  COMMAND ${CMAKE_SOURCE_DIR}/tools/package-files $<TARGET_FILE:cgsr> ${CGSR_PACKAGE_FILES}
  DEPENDS cgsr COMMENT "man pages and shell completion, from the command line's own description" VERBATIM)
install(DIRECTORY ${CGSR_PACKAGE_FILES}/man1 DESTINATION share/man COMPONENT cgsr OPTIONAL)
install(FILES ${CGSR_PACKAGE_FILES}/completion RENAME cgsr DESTINATION share/bash-completion/completions COMPONENT cgsr OPTIONAL)

foreach(component cgsr cgsr-opengl cgsr-simulator cgsr-map cgsr-lab)
  install(FILES cmake/package/copyright DESTINATION share/doc/${component} COMPONENT ${component})
  install(FILES ${CGSR_PACKAGE_FILES}/changelog.gz DESTINATION share/doc/${component} COMPONENT ${component} OPTIONAL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cgsr)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "CGSR-Vision maintainers <maintainers@cgsr-vision.invalid>")
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_SET_DESTDIR ON)  # /etc lies outside the prefix
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL cgsr cgsr-opengl cgsr-simulator cgsr-map cgsr-lab)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})

# cgsr_package(COMPONENT "summary" "description")
function(cgsr_package component summary description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${description}" PARENT_SCOPE)
endfunction()
cgsr_package(cgsr "colour vision for a mobile robot under changing light"
"The robot's program: from camera images to wheel commands. It follows a person
or an object by colour, corrects its pose against a map, and locates lamps by
the shadows that they cast. A service runs it from boot on.")
cgsr_package(cgsr-opengl "expected view by OpenGL for cgsr"
"A plug-in for cgsr that draws the expected view of a map with Mesa instead of
the program's own rasteriser (localizer.expectation = opengl).")
cgsr_package(cgsr-simulator "simulated home for cgsr"
"A plug-in for cgsr with a ray-traced home, a Segway on a virtual CAN bus and
lamps, and the tools that draw and export its worlds.")
cgsr_package(cgsr-map "map refined from a drive, for cgsr"
"The program behind `cgsr map refine`: it moves the parts of a measured map to
where the images of a drive show them, and proposes edges that it lacks.")
cgsr_package(cgsr-lab "measurements of cgsr"
"The program behind `cgsr reproduce`: the tables and figures of the dissertation
measured anew, beside trackers of others.")
set(CPACK_DEBIAN_CGSR_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers | systemd-sysusers")
set(CPACK_DEBIAN_CGSR_PACKAGE_RECOMMENDS "systemd, udev, opencv-data")
set(CPACK_DEBIAN_CGSR_PACKAGE_SUGGESTS "cgsr-opengl, cgsr-simulator, cgsr-map")
foreach(component OPENGL SIMULATOR MAP LAB)
  set(CPACK_DEBIAN_CGSR-${component}_PACKAGE_DEPENDS "cgsr (= ${PROJECT_VERSION})")
endforeach()
set(CPACK_DEBIAN_CGSR_PACKAGE_CONTROL_EXTRA
    "${CMAKE_SOURCE_DIR}/cmake/package/postinst;${CMAKE_SOURCE_DIR}/cmake/package/prerm;${CMAKE_SOURCE_DIR}/cmake/package/postrm;${CMAKE_SOURCE_DIR}/cmake/package/conffiles")
set(CPACK_DEBIAN_CGSR_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
