// LELSM and updated LELSM: what their papers state of them, on chains with a piecewise-linear spring.
#include "reduction/lelsm.hpp"
#include "reduction/updated_lelsm.hpp"
#include "rival_cases.hpp"
using namespace rival;
int main(){
  for(double gap:{0.0,0.3,1.0,3.0}) for(double force:{0.01}){
    Scene s=make_scene(grounded_chain(gap,force),0.05,0.12);
    auto truth=peak_on(s.full->reduced(),s.window,23);
    printf("gap %g: full f %.6f rad/s a %.5f (size %d)\n",gap,truth.frequency_hz*2*M_PI,truth.amplitude,(int)s.full->reduced()->size());
    for(double bf:{0.3,0.5,0.8,1.2}){
    auto l=build(s,kind(plm::BasisKind::lelsm,bf)); auto u=build(s,kind(plm::BasisKind::lelsm_updated,bf));
    auto el=error_on(s,l->reduced()), eu=error_on(s,u->reduced());
    auto eo=error_on(s,span_of(*s.full->space(),linear_modes(*s.full->space(),false,l->reduced()->size())));
    auto eo2=error_on(s,span_of(*s.full->space(),linear_modes(*s.full->space(),false,u->reduced()->size())));
    printf("  lelsm %d: %.1e %.1e   open same %.1e %.1e  updated %d: %.1e %.1e open same %.1e %.1e\n",(int)l->reduced()->size(),el.frequency,el.amplitude,eo.frequency,eo.amplitude,(int)u->reduced()->size(),eu.frequency,eu.amplitude,eo2.frequency,eo2.amplitude);
    plm::SelectionRule r; r.min_hz=s.window.min_hz;r.max_hz=s.window.max_hz;r.below_factor=bf;
    auto um=plm::updated_lelsm_modes(*s.full->space(),r,0,false,plm::Watch());
    auto em=error_on(s,span_of(*s.full->space(),um.columns.columns(0,um.n_modes)));
    printf("       modes only %d %.1e %.1e;  share %g w %g a %g mean %g it %d settled %d; lelsm share",(int)um.n_modes,em.frequency,em.amplitude,um.motion.share[0],um.motion.frequency,um.motion.amplitude[0],um.motion.mean[0],(int)um.motion.iterations,um.motion.settled);
    for(double x:l->report().equivalent_share)printf(" %.3g",x);printf("\n");
    }
  }
}
