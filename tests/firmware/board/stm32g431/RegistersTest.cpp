// Our registers and constants against those of ST's headers, which st_literals.hpp has as numbers.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "firmware/board/stm32g431/clock_tree.hpp"
#include "firmware/board/stm32g431/pinout.hpp"
#include "firmware/board/stm32g431/registers/adc.hpp"
#include "firmware/board/stm32g431/registers/fdcan.hpp"
#include "firmware/board/stm32g431/registers/system.hpp"
#include "firmware/board/stm32g431/registers/timers.hpp"
#include "tests/firmware/board/stm32g431/st_literals.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::stm32g431;

namespace {

struct Comparison {
  const char* name;
  std::uint32_t ours;
  std::uint32_t theirs;
};

#define SAME(ours, theirs) \
  Comparison { #ours, ours, theirs }

/// Every register's address and every field's mask. Three masks are the part of ST's that we use: timers have
/// another bit of MMS, SMS and TS elsewhere, and TIM3's count has 16 bits.
constexpr Comparison kRegisters[] = {
    SAME(Rcc::base, st::RCC_BASE),
    SAME(Rcc::Cr::address, st::RCC_CR),
    SAME(Rcc::Cr::hsiOn.mask, st::RCC_CR_HSION),
    SAME(Rcc::Cr::hsiReady.mask, st::RCC_CR_HSIRDY),
    SAME(Rcc::Cr::hseOn.mask, st::RCC_CR_HSEON),
    SAME(Rcc::Cr::hseReady.mask, st::RCC_CR_HSERDY),
    SAME(Rcc::Cr::pllOn.mask, st::RCC_CR_PLLON),
    SAME(Rcc::Cr::pllReady.mask, st::RCC_CR_PLLRDY),
    SAME(Rcc::Cfgr::address, st::RCC_CFGR),
    SAME(Rcc::Cfgr::systemClock.mask, st::RCC_CFGR_SW),
    SAME(Rcc::Cfgr::systemClockStatus.mask, st::RCC_CFGR_SWS),
    SAME(Rcc::Cfgr::ahbPrescaler.mask, st::RCC_CFGR_HPRE),
    SAME(Rcc::Cfgr::apb1Prescaler.mask, st::RCC_CFGR_PPRE1),
    SAME(Rcc::Cfgr::apb2Prescaler.mask, st::RCC_CFGR_PPRE2),
    SAME(Rcc::PllCfgr::address, st::RCC_PLLCFGR),
    SAME(Rcc::PllCfgr::source.mask, st::RCC_PLLCFGR_PLLSRC),
    SAME(Rcc::PllCfgr::divideIn.mask, st::RCC_PLLCFGR_PLLM),
    SAME(Rcc::PllCfgr::multiply.mask, st::RCC_PLLCFGR_PLLN),
    SAME(Rcc::PllCfgr::outputOn.mask, st::RCC_PLLCFGR_PLLREN),
    SAME(Rcc::PllCfgr::divideOut.mask, st::RCC_PLLCFGR_PLLR),
    SAME(Rcc::Ahb1Enr::address, st::RCC_AHB1ENR),
    SAME(Rcc::Ahb1Enr::dma1.mask, st::RCC_AHB1ENR_DMA1EN),
    SAME(Rcc::Ahb1Enr::dmamux.mask, st::RCC_AHB1ENR_DMAMUX1EN),
    SAME(Rcc::Ahb1Enr::flash.mask, st::RCC_AHB1ENR_FLASHEN),
    SAME(Rcc::Ahb2Enr::address, st::RCC_AHB2ENR),
    SAME(Rcc::Ahb2Enr::gpioA.mask, st::RCC_AHB2ENR_GPIOAEN),
    SAME(Rcc::Ahb2Enr::gpioB.mask, st::RCC_AHB2ENR_GPIOBEN),
    SAME(Rcc::Ahb2Enr::gpioC.mask, st::RCC_AHB2ENR_GPIOCEN),
    SAME(Rcc::Ahb2Enr::adc12.mask, st::RCC_AHB2ENR_ADC12EN),
    SAME(Rcc::Apb1Enr1::address, st::RCC_APB1ENR1),
    SAME(Rcc::Apb1Enr1::tim2.mask, st::RCC_APB1ENR1_TIM2EN),
    SAME(Rcc::Apb1Enr1::tim3.mask, st::RCC_APB1ENR1_TIM3EN),
    SAME(Rcc::Apb1Enr1::fdcan.mask, st::RCC_APB1ENR1_FDCANEN),
    SAME(Rcc::Apb1Enr1::pwr.mask, st::RCC_APB1ENR1_PWREN),
    SAME(Rcc::Apb2Enr::address, st::RCC_APB2ENR),
    SAME(Rcc::Apb2Enr::tim1.mask, st::RCC_APB2ENR_TIM1EN),
    SAME(Rcc::Ccipr::address, st::RCC_CCIPR),
    SAME(Rcc::Ccipr::fdcanClock.mask, st::RCC_CCIPR_FDCANSEL),
    SAME(Rcc::Ccipr::adc12Clock.mask, st::RCC_CCIPR_ADC12SEL),
    SAME(Rcc::Csr::address, st::RCC_CSR),
    SAME(Rcc::Csr::remove.mask, st::RCC_CSR_RMVF),
    SAME(Rcc::Csr::optionBytes.mask, st::RCC_CSR_OBLRSTF),
    SAME(Rcc::Csr::pin.mask, st::RCC_CSR_PINRSTF),
    SAME(Rcc::Csr::brownOut.mask, st::RCC_CSR_BORRSTF),
    SAME(Rcc::Csr::software.mask, st::RCC_CSR_SFTRSTF),
    SAME(Rcc::Csr::independentWatchdog.mask, st::RCC_CSR_IWDGRSTF),
    SAME(Rcc::Csr::windowWatchdog.mask, st::RCC_CSR_WWDGRSTF),
    SAME(Rcc::Csr::lowPower.mask, st::RCC_CSR_LPWRRSTF),
    SAME(Pwr::base, st::PWR_BASE),
    SAME(Pwr::Cr1::address, st::PWR_CR1),
    SAME(Pwr::Cr1::voltageRange.mask, st::PWR_CR1_VOS),
    SAME(Pwr::Sr2::address, st::PWR_SR2),
    SAME(Pwr::Sr2::voltageChanging.mask, st::PWR_SR2_VOSF),
    SAME(Pwr::Cr5::address, st::PWR_CR5),
    SAME(Pwr::Cr5::normalMode.mask, st::PWR_CR5_R1MODE),
    SAME(Adc1::Isr::address, st::ADC1_ISR),
    SAME(Adc1::Isr::ready.mask, st::ADC_ISR_ADRDY),
    SAME(Adc1::Isr::overrun.mask, st::ADC_ISR_OVR),
    SAME(Adc1::Cr::address, st::ADC1_CR),
    SAME(Adc1::Cr::enable.mask, st::ADC_CR_ADEN),
    SAME(Adc1::Cr::start.mask, st::ADC_CR_ADSTART),
    SAME(Adc1::Cr::stop.mask, st::ADC_CR_ADSTP),
    SAME(Adc1::Cr::regulatorOn.mask, st::ADC_CR_ADVREGEN),
    SAME(Adc1::Cr::deepPowerDown.mask, st::ADC_CR_DEEPPWD),
    SAME(Adc1::Cr::calibrate.mask, st::ADC_CR_ADCAL),
    SAME(Adc1::Cfgr::address, st::ADC1_CFGR),
    SAME(Adc1::Cfgr::trigger.mask, st::ADC_CFGR_EXTSEL),
    SAME(Adc1::Cfgr::triggerEdge.mask, st::ADC_CFGR_EXTEN),
    SAME(Adc1::Cfgr::overwrite.mask, st::ADC_CFGR_OVRMOD),
    SAME(Adc1::Cfgr::injectedQueueOff.mask, st::ADC_CFGR_JQDIS),
    SAME(Adc1::Cfgr2::address, st::ADC1_CFGR2),
    SAME(Adc1::Cfgr2::oversample.mask, st::ADC_CFGR2_ROVSE),
    SAME(Adc1::Cfgr2::ratio.mask, st::ADC_CFGR2_OVSR),
    SAME(Adc1::Cfgr2::shift.mask, st::ADC_CFGR2_OVSS),
    SAME(Adc1::Smpr1::address, st::ADC1_SMPR1),
    SAME(Adc1::Smpr2::address, st::ADC1_SMPR2),
    SAME(Adc1::Sqr1::address, st::ADC1_SQR1),
    SAME(Adc1::Sqr2::address, st::ADC1_SQR2),
    SAME(Adc2::Isr::address, st::ADC2_ISR),
    SAME(Adc2::Isr::ready.mask, st::ADC_ISR_ADRDY),
    SAME(Adc2::Isr::overrun.mask, st::ADC_ISR_OVR),
    SAME(Adc2::Cr::address, st::ADC2_CR),
    SAME(Adc2::Cr::enable.mask, st::ADC_CR_ADEN),
    SAME(Adc2::Cr::start.mask, st::ADC_CR_ADSTART),
    SAME(Adc2::Cr::stop.mask, st::ADC_CR_ADSTP),
    SAME(Adc2::Cr::regulatorOn.mask, st::ADC_CR_ADVREGEN),
    SAME(Adc2::Cr::deepPowerDown.mask, st::ADC_CR_DEEPPWD),
    SAME(Adc2::Cr::calibrate.mask, st::ADC_CR_ADCAL),
    SAME(Adc2::Cfgr::address, st::ADC2_CFGR),
    SAME(Adc2::Cfgr::trigger.mask, st::ADC_CFGR_EXTSEL),
    SAME(Adc2::Cfgr::triggerEdge.mask, st::ADC_CFGR_EXTEN),
    SAME(Adc2::Cfgr::overwrite.mask, st::ADC_CFGR_OVRMOD),
    SAME(Adc2::Cfgr::injectedQueueOff.mask, st::ADC_CFGR_JQDIS),
    SAME(Adc2::Cfgr2::address, st::ADC2_CFGR2),
    SAME(Adc2::Cfgr2::oversample.mask, st::ADC_CFGR2_ROVSE),
    SAME(Adc2::Cfgr2::ratio.mask, st::ADC_CFGR2_OVSR),
    SAME(Adc2::Cfgr2::shift.mask, st::ADC_CFGR2_OVSS),
    SAME(Adc2::Smpr1::address, st::ADC2_SMPR1),
    SAME(Adc2::Smpr2::address, st::ADC2_SMPR2),
    SAME(Adc2::Sqr1::address, st::ADC2_SQR1),
    SAME(Adc2::Sqr2::address, st::ADC2_SQR2),
    SAME(Adc12::base, st::ADC12_COMMON_BASE),
    SAME(Adc12::Ccr::address, st::ADC12_COMMON_CCR),
    SAME(Adc12::Ccr::dual.mask, st::ADC_CCR_DUAL),
    SAME(Adc12::Ccr::dmaCircular.mask, st::ADC_CCR_DMACFG),
    SAME(Adc12::Ccr::dmaMode.mask, st::ADC_CCR_MDMA),
    SAME(Adc12::Ccr::clockMode.mask, st::ADC_CCR_CKMODE),
    SAME(Adc12::Ccr::prescaler.mask, st::ADC_CCR_PRESC),
    SAME(Adc12::Cdr::address, st::ADC12_COMMON_CDR),
    SAME(Dma1::base, st::DMA1_BASE),
    SAME(Dma1::Isr::address, st::DMA1_ISR),
    SAME(Dma1::Isr::halves1.mask, st::DMA_ISR_TCIF1 | st::DMA_ISR_HTIF1),
    SAME(Dma1::Isr::error1.mask, st::DMA_ISR_TEIF1),
    SAME(Dma1::Ifcr::address, st::DMA1_IFCR),
    SAME(Dma1::Ifcr::halves1.mask, st::DMA_IFCR_CTCIF1 | st::DMA_IFCR_CHTIF1),
    SAME(Dma1::Ifcr::error1.mask, st::DMA_IFCR_CTEIF1),
    SAME(Dma1::Ccr1::address, st::DMA1_Channel1_CCR),
    SAME(Dma1::Ccr1::enable.mask, st::DMA_CCR_EN),
    SAME(Dma1::Ccr1::circular.mask, st::DMA_CCR_CIRC),
    SAME(Dma1::Ccr1::incrementMemory.mask, st::DMA_CCR_MINC),
    SAME(Dma1::Ccr1::peripheralSize.mask, st::DMA_CCR_PSIZE),
    SAME(Dma1::Ccr1::memorySize.mask, st::DMA_CCR_MSIZE),
    SAME(Dma1::Ccr1::priority.mask, st::DMA_CCR_PL),
    SAME(Dma1::Cndtr1::address, st::DMA1_Channel1_CNDTR),
    SAME(Dma1::Cndtr1::left.mask, st::DMA_CNDTR_NDT),
    SAME(Dma1::Cpar1::address, st::DMA1_Channel1_CPAR),
    SAME(Dma1::Cmar1::address, st::DMA1_Channel1_CMAR),
    SAME(Dmamux::C0cr::address, st::DMAMUX1_Channel0_CCR),
    SAME(Dmamux::C0cr::request.mask, st::DMAMUX_CxCR_DMAREQ_ID),
    SAME(Tim1::Cr1::address, st::TIM1_CR1),
    SAME(Tim1::Cr1::enable.mask, st::TIM_CR1_CEN),
    SAME(Tim1::Cr2::address, st::TIM1_CR2),
    SAME(Tim1::Cr2::triggerOutput.mask, st::TIM_CR2_MMS_0 | st::TIM_CR2_MMS_1 | st::TIM_CR2_MMS_2),
    SAME(Tim1::Smcr::address, st::TIM1_SMCR),
    SAME(Tim1::Smcr::slaveMode.mask, st::TIM_SMCR_SMS_0 | st::TIM_SMCR_SMS_1 | st::TIM_SMCR_SMS_2),
    SAME(Tim1::Smcr::triggerInput.mask, st::TIM_SMCR_TS_0 | st::TIM_SMCR_TS_1 | st::TIM_SMCR_TS_2),
    SAME(Tim1::Egr::address, st::TIM1_EGR),
    SAME(Tim1::Egr::update.mask, st::TIM_EGR_UG),
    SAME(Tim1::Cnt::address, st::TIM1_CNT),
    SAME(Tim1::Psc::address, st::TIM1_PSC),
    SAME(Tim1::Arr::address, st::TIM1_ARR),
    SAME(Tim1::Cnt::count16.mask, st::TIM_CNT_CNT & 0xFFFF),
    SAME(Tim2::Cr1::address, st::TIM2_CR1),
    SAME(Tim2::Cr1::enable.mask, st::TIM_CR1_CEN),
    SAME(Tim2::Cr2::address, st::TIM2_CR2),
    SAME(Tim2::Cr2::triggerOutput.mask, st::TIM_CR2_MMS_0 | st::TIM_CR2_MMS_1 | st::TIM_CR2_MMS_2),
    SAME(Tim2::Smcr::address, st::TIM2_SMCR),
    SAME(Tim2::Smcr::slaveMode.mask, st::TIM_SMCR_SMS_0 | st::TIM_SMCR_SMS_1 | st::TIM_SMCR_SMS_2),
    SAME(Tim2::Smcr::triggerInput.mask, st::TIM_SMCR_TS_0 | st::TIM_SMCR_TS_1 | st::TIM_SMCR_TS_2),
    SAME(Tim2::Egr::address, st::TIM2_EGR),
    SAME(Tim2::Egr::update.mask, st::TIM_EGR_UG),
    SAME(Tim2::Cnt::address, st::TIM2_CNT),
    SAME(Tim2::Psc::address, st::TIM2_PSC),
    SAME(Tim2::Arr::address, st::TIM2_ARR),
    SAME(Tim2::Cnt::count16.mask, st::TIM_CNT_CNT & 0xFFFF),
    SAME(Tim3::Cr1::address, st::TIM3_CR1),
    SAME(Tim3::Cr1::enable.mask, st::TIM_CR1_CEN),
    SAME(Tim3::Cr2::address, st::TIM3_CR2),
    SAME(Tim3::Cr2::triggerOutput.mask, st::TIM_CR2_MMS_0 | st::TIM_CR2_MMS_1 | st::TIM_CR2_MMS_2),
    SAME(Tim3::Smcr::address, st::TIM3_SMCR),
    SAME(Tim3::Smcr::slaveMode.mask, st::TIM_SMCR_SMS_0 | st::TIM_SMCR_SMS_1 | st::TIM_SMCR_SMS_2),
    SAME(Tim3::Smcr::triggerInput.mask, st::TIM_SMCR_TS_0 | st::TIM_SMCR_TS_1 | st::TIM_SMCR_TS_2),
    SAME(Tim3::Egr::address, st::TIM3_EGR),
    SAME(Tim3::Egr::update.mask, st::TIM_EGR_UG),
    SAME(Tim3::Cnt::address, st::TIM3_CNT),
    SAME(Tim3::Psc::address, st::TIM3_PSC),
    SAME(Tim3::Arr::address, st::TIM3_ARR),
    SAME(Tim3::Cnt::count16.mask, st::TIM_CNT_CNT & 0xFFFF),
    SAME(Fdcan::base, st::FDCAN1_BASE),
    SAME(Fdcan::Dbtp::address, st::FDCAN1_DBTP),
    SAME(Fdcan::Dbtp::jump.mask, st::FDCAN_DBTP_DSJW),
    SAME(Fdcan::Dbtp::segment2.mask, st::FDCAN_DBTP_DTSEG2),
    SAME(Fdcan::Dbtp::segment1.mask, st::FDCAN_DBTP_DTSEG1),
    SAME(Fdcan::Dbtp::prescaler.mask, st::FDCAN_DBTP_DBRP),
    SAME(Fdcan::Dbtp::delayCompensation.mask, st::FDCAN_DBTP_TDC),
    SAME(Fdcan::Cccr::address, st::FDCAN1_CCCR),
    SAME(Fdcan::Cccr::init.mask, st::FDCAN_CCCR_INIT),
    SAME(Fdcan::Cccr::configurable.mask, st::FDCAN_CCCR_CCE),
    SAME(Fdcan::Cccr::fd.mask, st::FDCAN_CCCR_FDOE),
    SAME(Fdcan::Cccr::bitRateSwitch.mask, st::FDCAN_CCCR_BRSE),
    SAME(Fdcan::Nbtp::address, st::FDCAN1_NBTP),
    SAME(Fdcan::Nbtp::segment2.mask, st::FDCAN_NBTP_NTSEG2),
    SAME(Fdcan::Nbtp::segment1.mask, st::FDCAN_NBTP_NTSEG1),
    SAME(Fdcan::Nbtp::prescaler.mask, st::FDCAN_NBTP_NBRP),
    SAME(Fdcan::Nbtp::jump.mask, st::FDCAN_NBTP_NSJW),
    SAME(Fdcan::Ecr::address, st::FDCAN1_ECR),
    SAME(Fdcan::Ecr::txErrors.mask, st::FDCAN_ECR_TEC),
    SAME(Fdcan::Ecr::rxErrors.mask, st::FDCAN_ECR_REC),
    SAME(Fdcan::Ecr::rxPassive.mask, st::FDCAN_ECR_RP),
    SAME(Fdcan::Psr::address, st::FDCAN1_PSR),
    SAME(Fdcan::Psr::passive.mask, st::FDCAN_PSR_EP),
    SAME(Fdcan::Psr::warning.mask, st::FDCAN_PSR_EW),
    SAME(Fdcan::Psr::busOff.mask, st::FDCAN_PSR_BO),
    SAME(Fdcan::Tdcr::address, st::FDCAN1_TDCR),
    SAME(Fdcan::Tdcr::offset.mask, st::FDCAN_TDCR_TDCO),
    SAME(Fdcan::Ir::address, st::FDCAN1_IR),
    SAME(Fdcan::Ir::fifo0Lost.mask, st::FDCAN_IR_RF0L),
    SAME(Fdcan::Rxgfc::address, st::FDCAN1_RXGFC),
    SAME(Fdcan::Rxgfc::rejectExtendedRemote.mask, st::FDCAN_RXGFC_RRFE),
    SAME(Fdcan::Rxgfc::rejectStandardRemote.mask, st::FDCAN_RXGFC_RRFS),
    SAME(Fdcan::Rxgfc::otherExtended.mask, st::FDCAN_RXGFC_ANFE),
    SAME(Fdcan::Rxgfc::otherStandard.mask, st::FDCAN_RXGFC_ANFS),
    SAME(Fdcan::Rxgfc::overwrite.mask, st::FDCAN_RXGFC_F0OM),
    SAME(Fdcan::Rxgfc::standardCount.mask, st::FDCAN_RXGFC_LSS),
    SAME(Fdcan::Rxf0s::address, st::FDCAN1_RXF0S),
    SAME(Fdcan::Rxf0s::level.mask, st::FDCAN_RXF0S_F0FL),
    SAME(Fdcan::Rxf0s::getIndex.mask, st::FDCAN_RXF0S_F0GI),
    SAME(Fdcan::Rxf0a::address, st::FDCAN1_RXF0A),
    SAME(Fdcan::Rxf0a::index.mask, st::FDCAN_RXF0A_F0AI),
    SAME(Fdcan::Txbc::address, st::FDCAN1_TXBC),
    SAME(Fdcan::Txbc::queue.mask, st::FDCAN_TXBC_TFQM),
    SAME(Fdcan::Txfqs::address, st::FDCAN1_TXFQS),
    SAME(Fdcan::Txfqs::putIndex.mask, st::FDCAN_TXFQS_TFQPI),
    SAME(Fdcan::Txfqs::full.mask, st::FDCAN_TXFQS_TFQF),
    SAME(Fdcan::Txbrp::address, st::FDCAN1_TXBRP),
    SAME(Fdcan::Txbar::address, st::FDCAN1_TXBAR),
    SAME(Fdcan::Txbcr::address, st::FDCAN1_TXBCR),
    SAME(Fdcan::Txbto::address, st::FDCAN1_TXBTO),
    SAME(Fdcan::Txbcf::address, st::FDCAN1_TXBCF),
    SAME(Element0::standardId.mask, st::FDCAN_ELEMENT_MASK_STDID),
    SAME(Element0::remote.mask, st::FDCAN_ELEMENT_MASK_RTR),
    SAME(Element0::extended.mask, st::FDCAN_ELEMENT_MASK_XTD),
    SAME(Element1::length.mask, st::FDCAN_ELEMENT_MASK_DLC),
    SAME(Element1::fd.mask, st::FDCAN_ELEMENT_MASK_FDF),
    SAME(StandardFilter::id2.mask, 0x000007FF),
    SAME(StandardFilter::id1.mask, 0x07FF0000),
    SAME(StandardFilter::action.mask, 0x38000000),
    SAME(StandardFilter::type.mask, 0xC0000000),
    SAME(Flash::base, st::FLASH_R_BASE),
    SAME(Flash::Acr::address, st::FLASH_ACR),
    SAME(Flash::Acr::latency.mask, st::FLASH_ACR_LATENCY),
    SAME(Flash::Acr::prefetch.mask, st::FLASH_ACR_PRFTEN),
    SAME(Flash::Acr::instructionCache.mask, st::FLASH_ACR_ICEN),
    SAME(Flash::Acr::dataCache.mask, st::FLASH_ACR_DCEN),
    SAME(Flash::Acr::resetInstructionCache.mask, st::FLASH_ACR_ICRST),
    SAME(Flash::Acr::resetDataCache.mask, st::FLASH_ACR_DCRST),
    SAME(Flash::KeyR::address, st::FLASH_KEYR),
    SAME(Flash::Sr::address, st::FLASH_SR),
    SAME(Flash::Sr::endOfOperation.mask, st::FLASH_SR_EOP),
    SAME(Flash::Sr::busy.mask, st::FLASH_SR_BSY),
    SAME(Flash::Cr::address, st::FLASH_CR),
    SAME(Flash::Cr::program.mask, st::FLASH_CR_PG),
    SAME(Flash::Cr::pageErase.mask, st::FLASH_CR_PER),
    SAME(Flash::Cr::page.mask, st::FLASH_CR_PNB),
    SAME(Flash::Cr::start.mask, st::FLASH_CR_STRT),
    SAME(Flash::Cr::lock.mask, st::FLASH_CR_LOCK),
    SAME(Flash::EccR::address, st::FLASH_ECCR),
    SAME(Flash::EccR::offset.mask, st::FLASH_ECCR_ADDR_ECC),
    SAME(Flash::EccR::inSystemMemory.mask, st::FLASH_ECCR_SYSF_ECC),
    SAME(Flash::EccR::corrected.mask, st::FLASH_ECCR_ECCC),
    SAME(Flash::EccR::detected.mask, st::FLASH_ECCR_ECCD),
    SAME(Iwdg::base, st::IWDG_BASE),
    SAME(Iwdg::Kr::address, st::IWDG_KR),
    SAME(Iwdg::Pr::address, st::IWDG_PR),
    SAME(Iwdg::Rlr::address, st::IWDG_RLR),
    SAME(Iwdg::Sr::address, st::IWDG_SR),
    SAME(Iwdg::Sr::updating.mask, st::IWDG_SR_PVU | st::IWDG_SR_RVU | st::IWDG_SR_WVU),
    SAME(UniqueIdWords::base, st::UID_BASE),
    SAME(Dbgmcu::Apb1Fzr1::address, st::DBGMCU_APB1FZR1),
    SAME(Dbgmcu::Apb1Fzr1::stopWatchdog.mask, st::DBGMCU_APB1FZR1_DBG_IWDG_STOP),
};

/// Values of fields, keys, and how memories are divided.
constexpr Comparison kConstants[] = {
    SAME(Rcc::Cfgr::systemClock(Rcc::kHsi).value, st::RCC_CFGR_SW_HSI),
    SAME(Rcc::Cfgr::systemClock(Rcc::kHse).value, st::RCC_CFGR_SW_HSE),
    SAME(Rcc::Cfgr::systemClock(Rcc::kPll).value, st::RCC_CFGR_SW_PLL),
    SAME(Rcc::Cfgr::systemClockStatus(Rcc::kHsi).value, st::RCC_CFGR_SWS_HSI),
    SAME(Rcc::Cfgr::systemClockStatus(Rcc::kPll).value, st::RCC_CFGR_SWS_PLL),
    SAME(Rcc::Cfgr::ahbPrescaler(Rcc::kWhole).value, st::RCC_CFGR_HPRE_DIV1),
    SAME(Rcc::Cfgr::ahbPrescaler(Rcc::kHalf).value, st::RCC_CFGR_HPRE_DIV2),
    SAME(Rcc::PllCfgr::source(Rcc::kPllFromHsi).value, st::RCC_PLLCFGR_PLLSRC_HSI),
    SAME(Rcc::PllCfgr::source(Rcc::kPllFromHse).value, st::RCC_PLLCFGR_PLLSRC_HSE),
    SAME(Rcc::Ccipr::fdcanClock(Rcc::kFdcanFromHse).value, st::RCC_FDCANCLKSOURCE_HSE),
    SAME(Rcc::Ccipr::fdcanClock(Rcc::kFdcanFromPclk1).value, st::RCC_FDCANCLKSOURCE_PCLK1),
    SAME(Rcc::Ccipr::adc12Clock(Rcc::kAdc12FromSystemClock).value, st::RCC_ADC12CLKSOURCE_SYSCLK),
    SAME(Pwr::Cr1::voltageRange(1).value, st::PWR_CR1_VOS_0),
    SAME(kWaitStates, st::FLASH_ACR_LATENCY_4WS),
    SAME(Adc1::Cfgr::trigger(kTim1Trgo).value, st::ADC_CFGR_EXTSEL_3 | st::ADC_CFGR_EXTSEL_0),
    SAME(Adc1::Cfgr::triggerEdge(1).value, st::ADC_CFGR_EXTEN_0),
    SAME(Adc12::Ccr::dual(Adc12::kRegularSimultaneous).value, st::LL_ADC_MULTI_DUAL_REG_SIMULT),
    SAME(Adc12::Ccr::dmaMode(Adc12::kBothInAWord).value, st::ADC_DMAACCESSMODE_12_10_BITS),
    SAME(Adc12::Ccr::prescaler(Adc12::kDivideBy8).value, st::LL_ADC_CLOCK_ASYNC_DIV8),
    SAME(Dmamux::kAdc1, st::DMA_REQUEST_ADC1),
    SAME(Dma1::Ccr1::peripheralSize(Dma1::kWord).value, st::DMA_PDATAALIGN_WORD),
    SAME(Dma1::Ccr1::memorySize(Dma1::kWord).value, st::DMA_MDATAALIGN_WORD),
    SAME(Dma1::Ccr1::priority(Dma1::kHighest).value, st::DMA_PRIORITY_VERY_HIGH),
    SAME(Tim1::Cr2::triggerOutput(kAtUpdate).value, st::LL_TIM_TRGO_UPDATE),
    SAME(Tim3::Smcr::slaveMode(kCountInput).value, st::LL_TIM_CLOCKSOURCE_EXT_MODE1),
    SAME(Tim3::Smcr::triggerInput(kItr0).value, st::LL_TIM_TS_ITR0),
    SAME(Fdcan::kReject, st::FDCAN_REJECT),
    SAME(Fdcan::kToFifo0, st::FDCAN_ACCEPT_IN_RX_FIFO0),
    SAME(StandardFilter::kToFifo0, st::FDCAN_FILTER_TO_RXFIFO0),
    SAME(StandardFilter::kEither, st::FDCAN_FILTER_DUAL),
    SAME(MessageRam::base, st::SRAMCAN_BASE),
    SAME(MessageRam::elements, st::SRAMCAN_RF0_NBR),
    SAME(MessageRam::elements, st::SRAMCAN_TFQ_NBR),
    SAME(MessageRam::elementBytes, st::SRAMCAN_RF0_SIZE),
    SAME(MessageRam::elementBytes, st::SRAMCAN_TFQ_SIZE),
    SAME(MessageRam::standardFilters, st::SRAMCAN_FLS_NBR),
    SAME(MessageRam::filter(1), st::SRAMCAN_BASE + st::SRAMCAN_FLSSA + st::SRAMCAN_FLS_SIZE),
    SAME(MessageRam::fifo0(2), st::SRAMCAN_BASE + st::SRAMCAN_RF0SA + 2 * st::SRAMCAN_RF0_SIZE),
    SAME(MessageRam::tx(2), st::SRAMCAN_BASE + st::SRAMCAN_TFQSA + 2 * st::SRAMCAN_TFQ_SIZE),
    SAME(Flash::firstKey, st::FLASH_KEY1),
    SAME(Flash::secondKey, st::FLASH_KEY2),
    SAME(kFlashBegin, st::FLASH_BASE),
    SAME(kFlashPageBytes, st::FLASH_PAGE_SIZE),
    SAME(Flash::Sr::errors, st::FLASH_SR_OPERR | st::FLASH_SR_PROGERR | st::FLASH_SR_WRPERR |
                                st::FLASH_SR_PGAERR | st::FLASH_SR_SIZERR | st::FLASH_SR_PGSERR |
                                st::FLASH_SR_MISERR | st::FLASH_SR_FASTERR),
    SAME(Iwdg::kFeed, st::IWDG_KEY_RELOAD),
    SAME(Iwdg::kUnlock, st::IWDG_KEY_WRITE_ACCESS_ENABLE),
    SAME(Iwdg::kStart, st::IWDG_KEY_ENABLE),
    SAME(Gpio::base, st::GPIOA_BASE),
    SAME(Gpio::base + Gpio::portStride, st::GPIOB_BASE),
    SAME(Gpio::base + 2 * Gpio::portStride, st::GPIOC_BASE),
    SAME(Gpio::base + Gpio::mode, st::GPIOA_MODER),
    SAME(Gpio::base + Gpio::speed, st::GPIOA_OSPEEDR),
    SAME(Gpio::base + Gpio::pull, st::GPIOA_PUPDR),
    SAME(Gpio::base + Gpio::alternate, st::GPIOA_AFR),
    SAME(Gpio::kAlternate, st::GPIO_MODER_MODE0_1),
    SAME(Gpio::kAnalog, st::GPIO_MODER_MODE0),
    SAME(Gpio::kOutput, st::GPIO_MODER_MODE0_0),
    SAME(Gpio::kUp, st::GPIO_PUPDR_PUPD0_0),
    SAME(Gpio::kHighSpeed, st::GPIO_OSPEEDR_OSPEED0_1),
    SAME(kCanFunction, st::GPIO_AF9_FDCAN1),
};

/// Names of all registers and fields that registers/*.hpp define, as kRegisters should have them.
std::vector<std::string> definedNames(const std::string& text) {
  static const std::regex kDefinition(
      R"(\n(struct) (\w+)|\n  struct (\w+) : Register<|Field<\w+, [^>]*>\s*(\w+)\{\})");
  std::vector<std::string> names;
  std::string peripheral, nested;
  for (std::sregex_iterator match(text.begin(), text.end(), kDefinition), end; match != end; ++match) {
    if ((*match)[1].matched) {
      peripheral = (*match)[2].str() + "::";
      nested.clear();
    } else if ((*match)[3].matched) {
      nested = (*match)[3].str() + "::";
      names.push_back(peripheral + nested + "address");
    } else {
      names.push_back(peripheral + nested + (*match)[4].str() + ".mask");
    }
  }
  return names;
}

/// A name of a template for each of its instances.
std::vector<std::string> instancesOf(const std::string& name) {
  std::vector<std::string> names;
  const std::string rest = name.substr(name.find(':'));
  if (name.starts_with("Adc::")) return {"Adc1" + rest, "Adc2" + rest};
  if (name.starts_with("Timer::")) return {"Tim1" + rest, "Tim2" + rest, "Tim3" + rest};
  return {name};
}

}  // namespace

TEST_GROUP(Registers){template <typename Comparisons> static void checkAll(const Comparisons& comparisons){
    for (const Comparison& each
         : comparisons) LONGS_EQUAL_TEXT(each.theirs, each.ours, each.name);
}
}
;

TEST(Registers, HaveStsAddressesAndMasks) { checkAll(kRegisters); }

TEST(Registers, TakeStsValues) { checkAll(kConstants); }

TEST(Registers, AllAreCompared) {
  const std::filesystem::path folder = STRAINFINGER_ROOT "/firmware/board/stm32g431/registers";
  std::size_t defined = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(file.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (const std::string& name : definedNames(text))
      for (const std::string& instance : instancesOf(name)) {
        ++defined;
        CHECK_TRUE_TEXT(std::ranges::count(kRegisters, instance, &Comparison::name) == 1, instance.c_str());
      }
  }
  CHECK_TRUE(defined >= 236);
}
