# cmake -DNPM=... -DSOURCE=... -DFOLDER=... -P install.cmake: installs the packages of package-lock.json into FOLDER/node_modules.
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" "${SOURCE}/.npmrc" DESTINATION "${FOLDER}")
execute_process(COMMAND "${NPM}" ci --ignore-scripts --no-progress --loglevel=error
  WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "npm could not install the viewer's packages. Without a network: cmake -DDISMANTLE_VIEWER=OFF builds without the viewer.")
endif()
file(TOUCH "${FOLDER}/installed")
