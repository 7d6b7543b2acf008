# cmake --install build/release --prefix P: the program, the bundled scenes, the manual page, shell
# completion, and the documents that help and manual page refer to. The prefix may be moved later:
# the program finds its scenes from where it is (scene/find_scene.cpp).
install(TARGETS stromboli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY scene/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/stromboli/scenes
        FILES_MATCHING PATTERN *.dae PATTERN *.glb PATTERN *.xml PATTERN *.hdr PATTERN *.ply PATTERN *.png)
install(FILES ${STROMBOLI_MANUAL}/stromboli.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${STROMBOLI_MANUAL}/stromboli.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME stromboli)
install(FILES ${STROMBOLI_MANUAL}/stromboli.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${STROMBOLI_MANUAL}/_stromboli
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
        FILES_MATCHING PATTERN *.md PATTERN *.png PATTERN *.webp PATTERN docs/pictures/README.md EXCLUDE)
install(FILES scene/library/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/scene/library)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(changelog ${CMAKE_BINARY_DIR}/changelog.gz)
add_custom_command(OUTPUT ${changelog}
                   COMMAND ${GZIP} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${changelog}
                   DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM)
add_custom_target(stromboli_changelog ALL DEPENDS ${changelog})
install(FILES ${changelog} DESTINATION ${CMAKE_INSTALL_DOCDIR})
