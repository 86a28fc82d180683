/* The state of floating point that the library computes in, whatever the caller's is. */
#include "core/text.h"

void skg_plain_enter(skg_plain *plain) {
    fegetenv(&plain->arithmetic);
    fesetenv(FE_DFL_ENV);
    plain->c = newlocale(LC_ALL_MASK, "C", (locale_t)0); /* built in: needs no memory, cannot fail */
    plain->numbers = uselocale(plain->c);
}

void skg_plain_leave(skg_plain *plain) {
    uselocale(plain->numbers);
    if (plain->c) freelocale(plain->c);
    fesetenv(&plain->arithmetic);
}
