#![no_std]
#![no_main]

surface::image!(surface::gnss_ppp::run);
