/* `devices --test`: every device, with all kernels. */
#ifndef SKG_CLI_DEVICE_TESTS_H
#define SKG_CLI_DEVICE_TESTS_H

/* Tests and prints a table, or with json an object. config: the value of --device, or NULL; a driver that it names is tested,
 * too. Returns an exit status. */
int cli_device_tests(const char *config, int json);

#endif
