//! Everything of `kestirim-gnss-ppp`, linked.

#![no_std]
#![no_main]

surface::image!(surface::gnss_ppp::run);
